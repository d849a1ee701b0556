// The report of `furrow validate` on a scenario.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// Output of `furrow validate`: figures by name, or lines for users. Without `time` it leaves out durations.
nlohmann::ordered_json validation_report(const Scenario& scenario, const RunTime* time = nullptr);
std::string validation_text(const Scenario& scenario, const RunTime* time = nullptr);

}  // namespace furrow::scenario
