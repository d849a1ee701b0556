// Reads a scenario: the user's JSON file, checked, completed with the schema's defaults, made into a Scenario.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/scenario/scenario.hpp"
#include "nodes/scenario/scenario_checks.hpp"

namespace furrow::scenario {

/// Reads, applies `--set key=value` pairs, validates and completes a scenario. @param purpose of reading it
/// @throws Error(bad_input) naming file, key, the mistake and the expected value; one line per mistake.
Scenario load_scenario(const std::filesystem::path& file, const Settings& settings, Purpose purpose = Purpose::run);

/// Checks whether a key may differ when a run is continued: it sets the duration, the computation or the output, but
/// does not affect the physics.
bool may_change_on_resume(const std::string& key);
/// Checks whether a failed run may be continued with another value of this key: it sets how finely the run is stepped.
bool steps_finer(const std::string& key);

}  // namespace furrow::scenario
