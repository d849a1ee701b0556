#include "nodes/scenario/scenario.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::scenario {

std::vector<std::string> Scenario::file_hashes() const {
  std::vector<std::string> hashes;
  for (const auto& tire : tires)
    hashes.push_back(text_hash(read_text_file(tire->options().file, "a tire file in JSON", false)));
  for (const terrain::TerrainFile& file : terrain->files()) hashes.push_back(file_hash(file.path));
  for (const rigs::RigFile& file : rig->files()) hashes.push_back(file_hash(file.path));
  for (const auto& spec : tires)
    for (const std::filesystem::path& file : spec->files()) hashes.push_back(file_hash(file));
  return hashes;
}

std::vector<InputFile> Scenario::input_files() const {
  std::vector<InputFile> files;
  for (std::size_t k = 0; k < tires.size(); ++k) files.push_back({tire_key(k, "file"), tires[k]->options().file});
  for (const terrain::TerrainFile& file : terrain->files()) files.push_back({"terrain." + file.key, file.path});
  for (const rigs::RigFile& file : rig->files()) files.push_back({"rig." + file.key, file.path});
  for (std::size_t k = 0; k < tires.size(); ++k)
    for (const std::filesystem::path& file : tires[k]->files()) files.push_back({tire_key(k, "file"), file});
  return files;
}

std::string Scenario::tire_key(std::size_t wheel, const std::string& name) const {
  FURROW_ASSERT(in_range(wheel, tires.size()), wheel, tires.size());
  return tires_listed ? fmt::format("tires.{}.{}", wheel, name) : "tire." + name;
}

bool Scenario::prompt(std::size_t wheel) const {
  const tire::TireDescription tire = tires.at(wheel)->describe();
  return (tire.follows_rim || !tire.own_contact.empty()) && terrain->describe().answers_at_once;
}

bool Scenario::has_own_contact() const {
  return std::ranges::any_of(tires, [](const auto& tire) { return !tire->describe().own_contact.empty(); });
}

terrain::TerrainContext Scenario::terrain_context() const {
  terrain::TerrainContext context;
  context.step = terrain_step();
  context.seed = run.seed;
  context.gravity = rig->gravity();
  context.threads = context.settle_threads = settle_threads;
  for (const auto& tire : tires) context.contact_tangents |= tire->options().contact_tangent;
  return context;
}

terrain::dem::DemOptions Scenario::grains(const std::string& what) const {
  if (const terrain::dem::DemOptions* options = terrain->grains())
    return terrain::dem::with_context(*options, terrain_context());
  throw input_error(
      file.string(), "terrain.engine",
      "is '" + terrain->describe().engine + "', expected " + terrain::engines_with_grains() + ": " + what);
}

std::int64_t RunOptions::steps() const { return std::llround(end / step); }

std::int64_t RunOptions::steps_in(double interval) const {
  FURROW_ASSERT(step > 0.0, step);
  if (interval <= 0.0) return 0;
  return std::max<std::int64_t>(1, std::llround(interval / step));
}

}  // namespace furrow::scenario
