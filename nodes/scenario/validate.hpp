// What `furrow validate` says of a scenario.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// What `furrow validate` prints: the figures by name, or as lines for people. Without `time` it says nothing of time.
nlohmann::ordered_json validation_report(const Scenario& scenario, const RunTime* time = nullptr);
std::string validation_text(const Scenario& scenario, const RunTime* time = nullptr);

}  // namespace furrow::scenario
