#include "terrain/liggghts/liggghts_spec.hpp"

#include <nlohmann/json.hpp>

#include "terrain/dem/dem_spec.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/liggghts_terrain.hpp"
#include "terrain/liggghts/saved_grains.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr int kMostRanks = 4096;
// Peak of the rank that owns the grain, while the engine takes over the bed. Measured by the peak of the processes,
// which grew by 1840 bytes for each grain from 24,340 to 97,684 on one rank, and by 1590 to 1770 on each of two.
constexpr double kBytesPerGrain = 1800.0;

class LiggghtsSpec final : public TerrainSpec {
 public:
  explicit LiggghtsSpec(LiggghtsOptions options) : options_(std::move(options)) {}

  TerrainDescription describe() const override {
    TerrainDescription d = dem::describe_grains(options_);
    d.engine = "liggghts";
    d.name = "grains in LIGGGHTS, law " + options_.law;
    d.most_ranks = kMostRanks;
    d.core_per_rank = true;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext& context) const override {
    TerrainEstimate e = estimate_dem_terrain(dem::with_context(options_, context));
    e.memory_bytes = kBytesPerGrain * static_cast<double>(e.grains);
    return e;
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    return make_liggghts_terrain(dem::with_context(options_, context));
  }
  std::vector<TerrainFile> files() const override { return dem::bed_files(options_); }
  std::string lacking() const override { return engine_library_problem(); }
  const dem::DemOptions* grains() const override { return &options_; }
  Archive joined_state(std::vector<Archive> parts, const TerrainContext& context) const override {
    return as_solver_state(parts, dem::with_context(options_, context));
  }

 private:
  LiggghtsOptions options_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_liggghts_spec(const nlohmann::json& section, const ReadContext& context) {
  LiggghtsOptions options;
  dem::read_grain_keys(section, context, options);
  return std::make_unique<LiggghtsSpec>(std::move(options));
}

}  // namespace furrow::terrain::liggghts
