// Reads a scenario: the user's JSON file, checked, completed with the schema's defaults, made into a Scenario.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/scenario/scenario.hpp"
#include "nodes/scenario/scenario_checks.hpp"

namespace furrow::scenario {

/// Reads, applies `--set key=value` pairs, validates and completes a scenario. @param purpose what it is read for
/// @throws Error(bad_input) naming file, key, what is wrong and what is expected; one line per mistake.
Scenario load_scenario(const std::filesystem::path& file, const Settings& settings, Purpose purpose = Purpose::run);

/// Which keys may differ when a run is continued: they say how long, how it is computed and what is written, and leave
/// the physics alone.
bool may_change_on_resume(const std::string& key);
/// Whether a run that has failed may be continued with another value of this key: it says
/// how finely the run is stepped.
bool steps_finer(const std::string& key);

}  // namespace furrow::scenario
