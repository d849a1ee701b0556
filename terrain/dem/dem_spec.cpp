#include "terrain/dem/dem_spec.hpp"

#include <nlohmann/json.hpp>

#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "terrain/dem/dem_terrain.hpp"

namespace furrow::terrain::dem {
namespace {

class DemSpec final : public TerrainSpec {
 public:
  explicit DemSpec(DemOptions options) : options_(std::move(options)) {}

  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "dem";
    d.name = "grains, law " + options_.law;
    d.law = options_.law;
    d.grain_radius = options_.radius;
    d.gives_tangents = true;
    d.unstable_step_allowed = options_.allow_unstable_step;
    d.bounds = {options_.length, options_.width};
    if (options_.undisturbed_height >= 0.0) d.undisturbed_height = options_.undisturbed_height;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext& context) const override {
    return estimate_dem_terrain(with_context(options_, context));
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    return make_dem_terrain(with_context(options_, context));
  }
  std::vector<TerrainFile> files() const override {
    if (options_.bed.empty()) return {};
    return {{"bed", options_.bed}};
  }
  const DemOptions* grains() const override { return &options_; }

 private:
  DemOptions options_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_dem_spec(const nlohmann::json& section, const ReadContext& context) {
  DemOptions options;
  options.scenario = context.file;
  read_fields(section, options);
  if (!options.bed.empty()) options.bed = find_file(options.bed, context.key("bed"), context.file).string();
  return make_dem_spec(options);
}

std::unique_ptr<TerrainSpec> make_dem_spec(const DemOptions& options) {
  return std::make_unique<DemSpec>(options);
}

}  // namespace furrow::terrain::dem
