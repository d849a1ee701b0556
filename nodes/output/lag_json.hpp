// Energy of late forces, in the summary of a run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "nodes/output/results.hpp"

namespace furrow::output {

/// `interface` of summary.json: energy that late forces create or take from `from` on, for the ground and the rim of
/// each wheel, and the residual of the rig's own time integration.
nlohmann::ordered_json lag_json(const SummaryInput& input, double from);

}  // namespace furrow::output
