#include "terrain/terrains.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/dem_spec.hpp"
#include "terrain/extra_terrains.hpp"
#include "terrain/liggghts/liggghts_options.hpp"
#include "terrain/liggghts/liggghts_spec.hpp"
#include "terrain/rigid/ground_options.hpp"
#include "terrain/rigid/ground_spec.hpp"
#include "terrain/scm/scm_options.hpp"
#include "terrain/scm/scm_spec.hpp"

namespace furrow::terrain {
namespace {

constexpr auto kTerrains = std::to_array<TerrainEntry>({
    {"dem", "soil made of grains", key_list<dem::DemOptions>(), dem::read_dem_spec},
    {"rigid", "hard ground, the plane z = 0 or a profile", key_list<GroundOptions>(), read_ground_spec},
    {"liggghts", "soil made of grains, in LIGGGHTS, on any number of ranks", key_list<liggghts::LiggghtsOptions>(),
     liggghts::read_liggghts_spec, liggghts::is_key_of_dem_only},
    {"scm", "empirical soil, described by the results of plate and shear tests", key_list<scm::ScmOptions>(),
     scm::read_scm_spec},
});

/// "'dem' or 'rigid'": names of the engines for which `wanted` returns true.
template <class Wanted>
std::string names_of(const Wanted& wanted) {
  std::vector<std::string> names;
  for (const TerrainEntry& entry : terrains())
    if (wanted(entry)) names.emplace_back(entry.name);
  return one_of(names);
}

}  // namespace

std::span<const TerrainEntry> terrains() {
  static const std::vector<TerrainEntry> all = [] {
    std::vector<TerrainEntry> entries(kTerrains.begin(), kTerrains.end());
    const std::span<const TerrainEntry> extra = extra_terrains();
    entries.insert(entries.end(), extra.begin(), extra.end());
    return entries;
  }();
  return all;
}

const TerrainEntry& find_terrain(const std::string& engine, const ReadContext& context) {
  for (const TerrainEntry& entry : terrains())
    if (engine == entry.name) return entry;
  const std::string names = names_of([](const TerrainEntry&) { return true; });
  throw input_error(context.file, context.key("engine"), "is '" + engine + "', expected " + names);
}

std::vector<std::string> engines_of_key(const std::string& key) {
  std::vector<std::string> engines;
  for (const TerrainEntry& entry : terrains())
    for (const Field& field : entry.keys.fields())
      if (field.is(role::key) && key == field.name) engines.emplace_back(entry.name);
  return engines;
}

std::vector<std::string> terrain_keys(unsigned roles) {
  std::vector<std::string> keys;
  for (const TerrainEntry& entry : terrains())
    for (const Field& field : entry.keys.fields())
      if (field.is(role::key | roles) && std::find(keys.begin(), keys.end(), field.name) == keys.end())
        keys.emplace_back(field.name);
  return keys;
}

bool engine_denies(std::string_view engine, std::string_view key) {
  return std::ranges::any_of(terrains(), [&](const TerrainEntry& entry) {
    return engine == entry.name && entry.denies != nullptr && entry.denies(key);
  });
}

std::string engines_with_grains() {
  return names_of(
      [](const TerrainEntry& entry) { return entry.read(nlohmann::json::object(), {})->grains() != nullptr; });
}

std::string engines_with_stated_contacts() {
  return names_of([](const TerrainEntry& entry) {
    return entry.read(nlohmann::json::object(), {})->describe().takes_stated_contacts;
  });
}

Archive TerrainSpec::joined_state(std::vector<Archive> parts, const TerrainContext&) const {
  return std::move(parts.front());
}

std::shared_ptr<const TerrainSpec> default_terrain() {
  return find_terrain(CommonOptions().engine, {}).read(nlohmann::json::object(), {});
}

}  // namespace furrow::terrain
