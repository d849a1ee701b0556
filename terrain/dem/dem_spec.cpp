#include "terrain/dem/dem_spec.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "terrain/bulk_cohesion.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/gpu/gpu_grains.hpp"
#include "terrain/gpu/gpu_terrain.hpp"

namespace furrow::terrain::dem {
namespace {

class DemSpec final : public TerrainSpec {
 public:
  explicit DemSpec(DemOptions options) : options_(std::move(options)) {}

  TerrainDescription describe() const override {
    TerrainDescription d = describe_grains(options_);
    d.engine = "dem";
    d.name = (options_.on_gpu() ? "grains on a GPU, law " : "grains, law ") + options_.law;
    d.gives_tangents = !options_.on_gpu();
    return d;
  }
  TerrainEstimate estimate(const TerrainContext& context) const override {
    const DemOptions options = with_context(options_, context);
    if (options.on_gpu()) check_gpu_options(options);
    return estimate_dem_terrain(options);
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    const DemOptions options = with_context(options_, context);
    if (!options.on_gpu()) return make_dem_terrain(options);
    check_dem_run(options);
    return make_gpu_terrain(options);
  }
  std::string lacking() const override { return options_.on_gpu() ? gpu::gpu_library_problem() : ""; }
  const char* lacking_key() const override { return "device"; }
  std::string device_text(const TerrainContext& context) const override {
    return options_.on_gpu() ? gpu_text(options_, static_cast<double>(estimate(context).grains)) : "";
  }
  Archive joined_state(std::vector<Archive> parts, const TerrainContext& context) const override {
    if (!options_.on_gpu()) return TerrainSpec::joined_state(std::move(parts), context);
    return gpu_state_as_solver_state(parts.front(), with_context(options_, context));
  }
  std::vector<TerrainFile> files() const override { return bed_files(options_); }
  const DemOptions* grains() const override { return &options_; }

 private:
  DemOptions options_;
};

/// Keys of the law that is not chosen, where they are not at their default.
std::vector<std::pair<std::string, std::string>> keys_of_other_law(const DemOptions& o) {
  const DemOptions usual;
  std::vector<std::pair<std::string, std::string>> idle;
  const bool mindlin = o.law == "mindlin", hertz_tanh = o.law == "hertz_tanh";
  const auto look = [&](const char* key, auto DemOptions::*member, bool without) {
    if (without && o.*member != usual.*member)
      idle.emplace_back(key, fmt::format("has no effect: the law is '{}'", o.law));
  };
  look("young_modulus", &DemOptions::young_modulus, hertz_tanh);
  look("restitution", &DemOptions::restitution, hertz_tanh);
  look("normal_stiffness", &DemOptions::normal_stiffness, mindlin);
  look("normal_damping", &DemOptions::normal_damping, mindlin);
  look("friction_velocity_scale", &DemOptions::friction_velocity_scale, mindlin);
  look("friction_impulse_limit", &DemOptions::friction_impulse_limit, mindlin);
  return idle;
}

}  // namespace

TerrainDescription describe_grains(const DemOptions& options) {
  TerrainDescription d;
  d.remarks = keys_of_other_law(options);
  d.law = options.law;
  d.grain_radius = options.radius;
  d.gives_tangents = true;
  d.unstable_step_allowed = options.allow_unstable_step;
  d.bounds = {options.length, options.width};
  if (options.undisturbed_height >= 0.0) d.undisturbed_height = options.undisturbed_height;
  if (options.cone_index > 0.0) d.cone_index = options.cone_index;
  d.cohesive = kBulkCohesionShare * options.cohesion > kCohesionOfSand;
  return d;
}

void take_bulk_density(DemOptions& options) {
  if (options.bulk_density < 0.0) return;
  if (options.solid_fraction < 0.0)
    throw input_error(
        options.scenario, "terrain.bulk_density",
        fmt::format("is {:g} kg/m³, but terrain.solid_fraction is not given; expected both", options.bulk_density));
  options.density = options.bulk_density / options.solid_fraction;
}

std::vector<TerrainFile> bed_files(const DemOptions& options) {
  if (options.bed.empty()) return {};
  return {{"bed", options.bed}};
}

std::unique_ptr<TerrainSpec> read_dem_spec(const nlohmann::json& section, const ReadContext& context) {
  DemOptions options;
  read_grain_keys(section, context, options);
  return make_dem_spec(options);
}

std::unique_ptr<TerrainSpec> make_dem_spec(const DemOptions& options) { return std::make_unique<DemSpec>(options); }

}  // namespace furrow::terrain::dem
