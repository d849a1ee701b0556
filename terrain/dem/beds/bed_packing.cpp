#include "terrain/dem/beds/bed_packing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kSampleSide = 30.0;  // in largest radii: the fraction then has a standard deviation of 0.002
constexpr int kMostTries = 5;
constexpr double kSearchTolerance = 0.0015;
constexpr double kClosest = 0.01;  // looseness: beds closer than this differ only by chance

double drag_unit(const DemOptions& o) { return std::sqrt(o.gravity.norm() / o.radius); }

}  // namespace

double packing_tolerance(double solid_fraction) {
  return solid_fraction < kMetastable ? kLooseTolerance : kPackingTolerance;
}

DemOptions laid(DemOptions o, double looseness) {
  FURROW_ASSERT(std::abs(looseness) <= 1.0, looseness);
  o.solid_fraction = o.settling_friction = o.settling_cohesion = o.settling_drag = -1.0;
  if (looseness < 0.0) o.settling_friction = (1.0 + looseness) * o.friction;
  if (looseness < 0.0 && o.cohesion > 0.0) o.settling_cohesion = (1.0 + looseness) * o.cohesion;
  if (looseness > 0.0) {
    const double least = kFallDrag / drag_unit(o);
    o.settling_drag = least * std::pow(std::max(kLoosestDrag / least, 1.0), looseness);
  }
  return o;
}

double fall_drag(const DemOptions& o) { return o.settling_drag < 0.0 ? kFallDrag : o.settling_drag * drag_unit(o); }

DemOptions sample_of(const DemOptions& options) {
  DemOptions sample = options;
  sample.length = sample.width = kSampleSide * largest_radius(options);
  sample.periodic_x = sample.piece = true;
  sample.sides = "periodic";
  sample.tile = 0.0;
  sample.seed = 1;
  sample.solid_fraction = -1.0;
  return sample;
}

double PackingSearch::at(double looseness) {
  const auto found = known_.find(looseness);
  if (found != known_.end()) return found->second;
  return known_[looseness] = solid_fraction_(looseness);
}

double PackingSearch::looseness_for(double wanted) {
  const double end = at(0.0) > wanted ? 1.0 : -1.0;
  if ((at(end) - wanted) * end >= 0.0) return end;
  for (int k = 0; k < kMostTries; ++k) {
    auto loose = known_.end();  // the next looser and the next denser bed
    while (std::prev(loose)->second < wanted) --loose;
    const auto dense = std::prev(loose);
    if (loose->first - dense->first < kClosest) break;
    const double share = std::clamp((dense->second - wanted) / (dense->second - loose->second), 0.1, 0.9);
    if (std::abs(at(std::lerp(dense->first, loose->first, share)) - wanted) < kSearchTolerance) break;
  }
  return std::min_element(
             known_.begin(), known_.end(),
             [&](const auto& a, const auto& b) { return std::abs(a.second - wanted) < std::abs(b.second - wanted); })
      ->first;
}

void check_packing(const DemOptions& o) {
  if (o.solid_fraction >= 0.0 && o.compaction_pressure > 0.0)
    throw input_error(o.scenario, "terrain.compaction_pressure",
                      fmt::format("is {:g} Pa, but terrain.solid_fraction asks for a packing; expected one of the two",
                                  o.compaction_pressure));
}

}  // namespace furrow::terrain::dem
