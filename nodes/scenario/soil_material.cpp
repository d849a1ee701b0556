#include "nodes/scenario/soil_material.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/terrains.hpp"

namespace furrow::scenario {
namespace {

using nlohmann::json;

constexpr int kFormatVersion = 1;

/// The soil named in the scenario; null when it names none.
json named_material(const json& document, const std::filesystem::path& scenario) {
  const auto terrain = document.find("terrain");
  if (terrain == document.end() || !terrain->is_object()) return {};
  const auto name = terrain->find("material");
  if (name == terrain->end() || name->is_null()) return {};
  if (!name->is_string())
    throw input_error(scenario.string(), "terrain.material",
                      "is " + value_text(*name) + ", expected the name of a soil file or null");
  return read_soil_material(find_file(*name, "terrain.material", scenario));
}

}  // namespace

json read_soil_material(const std::filesystem::path& file) {
  const std::string name = file.string();
  const json soil = load_json(file, "a soil in JSON");
  JsonReader reader(soil, name);
  reader.child("terrain");
  reader.allow_only({"format_version", "description", "terrain", "measured"});
  reader.check_version(kFormatVersion, true);
  // The bin and the size of its grains are the scenario's.
  const std::vector<std::string> of_soil = terrain::terrain_keys(role::soil);
  for (const auto& [key, value] : soil["terrain"].items())
    if (std::find(of_soil.begin(), of_soil.end(), key) == of_soil.end())
      throw input_error(
          name, "terrain." + key,
          fmt::format("is not a property of soil, expected one of {}", fmt::join(of_soil, ", ")));
  json alone{{"terrain", soil["terrain"]}};
  const Schema schema = Schema::load();
  schema.normalize(alone);
  for (const Problem& problem : schema.problems(alone))
    if (problem.key.starts_with("terrain")) throw input_error(name, problem.key, problem.what);
  return alone["terrain"];
}

void apply_soil_material(json& document, const std::filesystem::path& scenario) {
  const json soil = named_material(document, scenario);
  for (const auto& [key, value] : soil.items())
    if (!document["terrain"].contains(key)) document["terrain"][key] = value;
}

void override_soil_material(json& document, const std::filesystem::path& scenario) {
  const json soil = named_material(document, scenario);
  for (const auto& [key, value] : soil.items()) document["terrain"][key] = value;
}

}  // namespace furrow::scenario
