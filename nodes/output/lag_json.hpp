// What late forces make or take, in the summary of a run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "nodes/output/results.hpp"

namespace furrow::output {

/// `interface` of summary.json: what late forces make or take from `from` on, interface by interface: ground and rim of
/// each wheel, and what the rig's own rule leaves over of the work that goes through it.
nlohmann::ordered_json lag_json(const SummaryInput& input, double from);

}  // namespace furrow::output
