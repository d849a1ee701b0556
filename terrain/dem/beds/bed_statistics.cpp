#include "terrain/dem/beds/bed_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "terrain/dem/beds/bed_height.hpp"
#include "terrain/dem/close_pairs.hpp"

namespace furrow::terrain::dem {

namespace {

double median_by_mass(const std::vector<Quad>& grains, double volume) {
  std::vector<double> radii;
  for (const Quad& grain : grains) radii.push_back(grain.w);
  std::sort(radii.begin(), radii.end());
  double below = 0.0;
  for (const double radius : radii)
    if ((below += volume_below(radius, 0.0, radius)) >= 0.5 * volume) return radius;
  return radii.back();
}

}  // namespace

double lens_volume(double a, double b, double distance) {
  FURROW_ASSERT(a > 0.0 && b > 0.0 && (distance > 0.0 || (distance == 0.0 && a == b)), a, b, distance);
  const double gap = a + b - distance;
  if (gap <= 0.0) return 0.0;
  const double unequal = a == b ? 0.0 : (a - b) * (a - b) / distance;
  return std::numbers::pi * gap * gap * (distance + 2.0 * (a + b) - 3.0 * unequal) / 12.0;
}

double volume_below(double radius, double z, double height) {
  FURROW_ASSERT(radius > 0.0, radius);
  // A cap of height h has the volume π h² (3 r − h) / 3.
  const double h = std::clamp(height - z + radius, 0.0, 2.0 * radius);
  return std::numbers::pi * h * h * (3.0 * radius - h) / 3.0;
}

BedStatistics bed_statistics(const std::vector<Quad>& positions, const Bin& bin, double radius,
                             const ProgressCall& progress) {
  FURROW_ASSERT(radius > 0.0, radius);
  BedStatistics s;
  s.grains = static_cast<std::int64_t>(positions.size());
  if (s.grains == 0) return s;
  Grains grains;
  grains.resize(static_cast<int>(positions.size()));
  grains.position = positions;
  const double half = 0.5 * bin.width;
  s.depth = mean_height(bed_height_field(grains, bin, 2.0 * radius), 0.0, bin.length, -half, half);
  const double low = 0.25 * s.depth, high = 0.75 * s.depth;

  double solid = 0.0, bulk = 0.0, largest = 0.0;
  for (const Quad& p : positions) {
    const double volume = volume_below(p.w, 0.0, 2.0 * p.w);
    solid += volume;
    s.grain_volume += volume;
    largest = std::max(largest, p.w);
    bulk += volume_below(p.w, p.z, high) - volume_below(p.w, p.z, low);
    s.top = std::max(s.top, p.z + p.w);
    for (int wall = 0; wall < kWalls; ++wall) s.wall_contacts += bin.has_wall(wall) && bin.distance(wall, p) < p.w;
  }
  s.median_by_mass = median_by_mass(positions, s.grain_volume);
  const auto count_pair = [&](std::size_t a, std::size_t b, double distance) {
    const double overlap = positions[a].w + positions[b].w - distance;
    if (overlap <= 0.0) return;
    const double lens = lens_volume(positions[a].w, positions[b].w, distance);
    const double z = 0.5 * (positions[a].z + positions[b].z);
    ++s.pairs;
    solid -= lens;
    if (z > low && z < high) bulk -= lens;
    s.max_overlap = std::max(s.max_overlap, overlap);
  };
  for_close_pairs(positions, bin, 2.0 * largest, count_pair, progress);
  s.coordination = 2.0 * static_cast<double>(s.pairs) / static_cast<double>(s.grains);
  s.solid_fraction = solid / (bin.length * bin.width * s.depth);
  s.solid_fraction_bulk = bulk / (bin.length * bin.width * (high - low));
  return s;
}

}  // namespace furrow::terrain::dem
