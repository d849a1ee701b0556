// Soil files: sets of values for the section `terrain`, with the strength that `furrow soil` measured for them. One
// file may describe a soil for several engines: each uses the values for its own keys.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

inline constexpr const char* kSoilKey = "material";

/// What a soil file gives.
struct SoilFile {
  nlohmann::json values = nlohmann::json::object();  // by their key in `terrain`
  nlohmann::json measured;                           // null: nothing
};

/// @throws Error(io) if it cannot be read, Error(bad_input) naming file and key.
SoilFile read_soil_file(const std::filesystem::path& file);
/// The values of a soil file alone. Throws like read_soil_file().
nlohmann::json read_soil_material(const std::filesystem::path& file);

/// Radius of the grains with which the soil's strength was measured, if it depends on their size, m; otherwise none.
std::optional<double> measured_radius(const SoilFile& soil);

/// Puts the values of the soil named by `terrain.material` into a scenario; the scenario's own values take precedence.
/// `scenario`: its file, for messages and as the first place to search. `engine`: its keys are used.
/// @throws Error(bad_input) if the engine uses soil files and this one has no value for it
void apply_soil_material(nlohmann::json& document, const std::filesystem::path& scenario, const std::string& engine);

/// Does the same for a soil named on the command line, but its values replace the scenario's own, cone index included.
/// Values of other settings stay, in whatever order they are given.
void override_soil_material(nlohmann::json& document, const std::filesystem::path& scenario, const std::string& engine,
                            const Settings& settings);

/// Fills a null `terrain.cone_index` of a completed scenario with the measured value of its soil, if the scenario uses
/// the soil unchanged.
void fill_cone_index(nlohmann::json& completed, const std::filesystem::path& scenario);

/// Returns a warning if the scenario states the cone index of its soil, and the settings change that soil alone; empty
/// otherwise.
std::string kept_cone_index_warning(const nlohmann::json& completed, const std::filesystem::path& scenario,
                                    const Settings& settings);

/// Returns a warning if the scenario uses a cohesive soil unchanged, but with grains of another size than in the soil's
/// measurements; empty otherwise. `completed`: the scenario with its defaults.
std::string other_grains_warning(const nlohmann::json& completed, const std::filesystem::path& scenario);

/// Returns a warning if engine scm takes some results of plate and shear tests from the named soil, or without one from
/// the scenario, but not all: the others would be those of another soil. Empty otherwise. `document`: the scenario
/// without defaults.
std::string partial_soil_warning(const nlohmann::json& document, const std::filesystem::path& scenario);

}  // namespace furrow::scenario
