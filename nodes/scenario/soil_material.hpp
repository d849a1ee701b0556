// Soil files: sets of values for the section `terrain`, with the strength that `furrow soil` measured for them. One
// file may describe a soil to several engines: each takes those values that are its keys.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow::scenario {

/// The key of the section `terrain` that names a soil file.
inline constexpr const char* kSoilKey = "material";

/// The values of a soil file by their key in `terrain`.
/// @throws Error(io) when it cannot be read, Error(bad_input) naming file and key.
nlohmann::json read_soil_material(const std::filesystem::path& file);

/// Puts the values of the soil named by `terrain.material` into a scenario, beneath those the scenario states itself.
/// `scenario`: its file, for messages and as the first place to look in. `engine`: whose keys are wanted.
/// @throws Error(bad_input) when the engine takes soil files and this one has no value for it
void apply_soil_material(nlohmann::json& document, const std::filesystem::path& scenario, const std::string& engine);

/// The same for a soil named on the command line: in place of those the scenario states.
void override_soil_material(nlohmann::json& document, const std::filesystem::path& scenario, const std::string& engine);

/// Fills `terrain.cone_index` of a completed scenario, where it is null, with what was measured of the soil that the
/// scenario takes as it is.
void fill_cone_index(nlohmann::json& completed, const std::filesystem::path& scenario);

/// What to say where the scenario takes a cohesive soil as it is, but with grains of another size than those that it
/// was measured with; empty otherwise. `completed`: the scenario with its defaults.
std::string other_grains_warning(const nlohmann::json& completed, const std::filesystem::path& scenario);

}  // namespace furrow::scenario
