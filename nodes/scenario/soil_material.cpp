#include "nodes/scenario/soil_material.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/file_kind.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/terrains.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr int kSoilVersion = 1;
constexpr double kSameSize = 0.01;  // of radii, relative
constexpr const char* kConeIndexKey = "cone_index";

bool takes(const std::string& engine, const std::string& key) {
  const std::vector<std::string> engines = terrain::engines_of_key(key);
  return std::find(engines.begin(), engines.end(), engine) != engines.end();
}

json values_for(const std::string& engine, const json& soil, const std::string& file) {
  json own = json::object();
  std::vector<std::string> others;
  for (const auto& [key, value] : soil.items()) {
    if (takes(engine, key))
      own[key] = value;
    else
      others.push_back(key);
  }
  if (own.empty() && !others.empty() && takes(engine, kSoilKey))
    throw input_error(file, "terrain", "has keys of other engines alone ({}), expected some of engine '{}'",
                      fmt::join(others, ", "), engine);
  return own;
}

}  // namespace

SoilFile read_soil_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  const json soil = load_json(file, "a soil in JSON");
  refuse_other_kinds(soil, FileKind::soil, name);
  JsonReader reader(soil, name);
  reader.child("terrain");
  reader.allow_only({"format_version", "description", "terrain", "measured"});
  reader.check_version(kSoilVersion, true);
  // The scenario itself sets the bin and the size of its grains.
  const std::vector<std::string> of_soil = terrain::terrain_keys(role::soil);
  for (const auto& [key, value] : soil["terrain"].items())
    if (std::find(of_soil.begin(), of_soil.end(), key) == of_soil.end())
      throw input_error(name, "terrain." + key, "is not a property of soil, expected one of {}",
                        fmt::join(of_soil, ", "));
  json alone{{"terrain", soil["terrain"]}};
  const Schema& schema = Schema::of_scenarios();
  schema.normalize(alone);
  for (const Problem& problem : schema.problems(alone))
    if (problem.key.starts_with("terrain")) throw input_error(name, problem.key, problem.what);
  return {alone["terrain"], soil.value("measured", json())};
}

std::optional<double> measured_radius(const SoilFile& soil) {
  const json with = soil.measured.is_object() ? soil.measured.value("grain_radius_m", json()) : json();
  const bool has_length = soil.values.value("cohesion", 0.0) != 0.0;
  if (!has_length || !with.is_number() || !(with.get<double>() > 0.0)) return {};
  return with.get<double>();
}

namespace {

/// The soil file that a completed scenario names; none if it names none.
std::optional<SoilFile> soil_of(const json& terrain, const std::filesystem::path& scenario) {
  const json name = terrain.value(kSoilKey, json());
  if (!name.is_string()) return {};
  return read_soil_file(find_file(name, "terrain.material", scenario));
}

/// Checks whether the scenario uses all of the soil's values and replaces none.
bool taken_whole(const SoilFile& soil, const json& terrain) {
  for (const auto& [key, value] : soil.values.items())
    if (terrain.contains(key) && terrain[key] != value) return false;
  return true;
}

/// measured_radius() if the scenario has grains of another size.
std::optional<double> other_radius(const SoilFile& soil, const json& terrain) {
  const json radius = terrain.value("radius", json());
  const std::optional<double> with = measured_radius(soil);
  if (!radius.is_number() || !with || std::abs(radius.get<double>() / *with - 1.0) <= kSameSize) return {};
  return with;
}

/// Values for the engine from the soil named in the scenario; null if none is named.
json named_material(const json& document, const std::filesystem::path& scenario, const std::string& engine) {
  const auto terrain = document.find("terrain");
  if (terrain == document.end() || !terrain->is_object()) return {};
  const auto name = terrain->find("material");
  if (name == terrain->end() || name->is_null()) return {};
  if (!name->is_string())
    throw input_error(scenario.string(), "terrain.material",
                      "is " + value_text(*name) + ", expected the name of a soil file or null");
  const std::filesystem::path file = find_file(*name, "terrain.material", scenario);
  return values_for(engine, read_soil_material(file), file.string());
}

/// @param key of the section `terrain`
bool is_set(const Settings& settings, const std::string& key) {
  return std::ranges::any_of(settings, [&](const auto& one) { return one.first == "terrain." + key; });
}

}  // namespace

json read_soil_material(const std::filesystem::path& file) { return read_soil_file(file).values; }

void apply_soil_material(json& document, const std::filesystem::path& scenario, const std::string& engine) {
  const json soil = named_material(document, scenario, engine);
  for (const auto& [key, value] : soil.items())
    if (!document["terrain"].contains(key)) document["terrain"][key] = value;
}

void override_soil_material(json& document, const std::filesystem::path& scenario, const std::string& engine,
                            const Settings& settings) {
  const json soil = named_material(document, scenario, engine);
  if (soil.is_null()) return;
  json& terrain = document["terrain"];
  if (!is_set(settings, kConeIndexKey)) terrain.erase(kConeIndexKey);  // of the scenario's own soil
  for (const auto& [key, value] : soil.items())
    if (!is_set(settings, key)) terrain[key] = value;
}

void fill_cone_index(json& completed, const std::filesystem::path& scenario) {
  json& terrain = completed.at("terrain");
  if (!terrain.contains(kConeIndexKey) || !terrain[kConeIndexKey].is_null()) return;
  const std::optional<SoilFile> soil = soil_of(terrain, scenario);
  if (!soil || !soil->measured.is_object() || !taken_whole(*soil, terrain) || other_radius(*soil, terrain)) return;
  const json index = soil->measured.value("cone_index_Pa", json());
  const json mean = index.is_object() ? index.value("mean", json()) : json();
  if (mean.is_number() && mean.get<double>() > 0.0) terrain[kConeIndexKey] = mean;
}

std::string kept_cone_index_warning(const json& completed, const std::filesystem::path& scenario,
                                    const Settings& settings) {
  const json& terrain = completed.at("terrain");
  if (!terrain.contains(kConeIndexKey) || terrain[kConeIndexKey].is_null() || is_set(settings, kConeIndexKey) ||
      is_set(settings, kSoilKey))
    return {};
  for (const std::string& key : terrain::terrain_keys(role::soil))
    if (is_set(settings, key))
      return input_error(scenario.string(), std::string("terrain.") + kConeIndexKey,
                         "is {} Pa, which the scenario states for its own soil, and terrain.{} was set: the "
                         "regressions of traction and the expected sinkage are those of the former soil, expected the "
                         "new soil's or null",
                         value_text(terrain[kConeIndexKey]), key)
          .what();
  return {};
}

std::string other_grains_warning(const json& completed, const std::filesystem::path& scenario) {
  const json& terrain = completed.at("terrain");
  const std::optional<SoilFile> soil = soil_of(terrain, scenario);
  if (!soil || !taken_whole(*soil, terrain)) return {};  // no soil, or a changed one
  const std::optional<double> with = other_radius(*soil, terrain);
  if (!with) return {};
  return input_error(
             scenario.string(), "terrain.radius",
             "is {} m, but the strength of '{}' was measured with grains of radius {} m: cohesion changes with the "
             "size of grains",
             number_text(terrain["radius"]), terrain[kSoilKey].get<std::string>(), number_text(*with))
      .what();
}

std::string partial_soil_warning(const json& document, const std::filesystem::path& scenario) {
  const json& terrain = document.at("terrain");
  if (terrain.value("engine", "") != "scm") return {};
  const std::optional<SoilFile> soil = soil_of(terrain, scenario);
  std::vector<std::string> given, open;
  for (const char* key : {"bekker_k_c", "bekker_k_phi", "bekker_n", "mohr_cohesion", "mohr_friction_angle", "janosi_k"})
    ((soil ? soil->values : terrain).contains(key) ? given : open).push_back(key);
  if (given.empty() || open.empty()) return {};
  const std::string others = fmt::format("{}", fmt::join(open, ", "));
  if (soil)
    return input_error(scenario.string(), std::string("terrain.") + kSoilKey,
                       "is '{}', which has {} but not {}: these are the scenario's or the defaults, of another soil",
                       terrain[kSoilKey].get<std::string>(), fmt::join(given, ", "), others)
        .what();
  return input_error(scenario.string(), "terrain." + given.front(),
                     "is given, but not {}: these are the defaults, of another soil", others)
      .what();
}

}  // namespace furrow::scenario
