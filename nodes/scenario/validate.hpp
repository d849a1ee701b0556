// What `furrow validate` says of a scenario.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

/// What `furrow validate` prints: the figures by name, or as lines for people.
nlohmann::ordered_json validation_report(const Scenario& scenario);
std::string validation_text(const Scenario& scenario);

}  // namespace furrow::scenario
