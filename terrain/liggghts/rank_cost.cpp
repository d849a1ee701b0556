#include "terrain/liggghts/rank_cost.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::liggghts {

RankLoad rank_load(const dem::DemOptions& options, int ranks) {
  FURROW_ASSERT(ranks > 0 && options.length > 0.0, ranks, options.length);
  const double grains = dem::expected_grains(options);
  const double reach = 2.0 * dem::largest_radius(options) + dem::kSkinShare * options.radius;
  RankLoad load;
  load.own = grains / ranks;
  load.ghosts = std::min(std::min(2, ranks - 1) * grains * reach / options.length, grains - load.own);
  return load;
}

double rank_step(const RankLoad& load, double grain_step) { return kGrainStep * grain_step * (load.own + load.ghosts); }

}  // namespace furrow::terrain::liggghts
