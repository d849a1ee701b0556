#include "terrain/dem/bed_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "terrain/dem/bed_height.hpp"
#include "terrain/dem/close_pairs.hpp"

namespace furrow::dem {

double lens_volume(double radius, double distance) {
  const double gap = 2.0 * radius - distance;
  return gap > 0.0 ? std::numbers::pi * (4.0 * radius + distance) * gap * gap / 12.0 : 0.0;
}

double volume_below(double radius, double z, double height) {
  // A cap of height h has the volume π h² (3 r − h) / 3.
  const double h = std::clamp(height - z + radius, 0.0, 2.0 * radius);
  return std::numbers::pi * h * h * (3.0 * radius - h) / 3.0;
}

BedStatistics bed_statistics(const std::vector<Quad>& positions, const Bin& bin, double radius) {
  BedStatistics s;
  s.grains = static_cast<std::int64_t>(positions.size());
  if (s.grains == 0) return s;
  Grains grains;
  grains.resize(static_cast<int>(positions.size()));
  grains.position = positions;
  const double half = 0.5 * bin.width;
  s.depth = mean_height(bed_height_field(grains, bin, radius), 0.0, bin.length, -half, half);
  const double low = 0.25 * s.depth, high = 0.75 * s.depth;

  const double sphere = volume_below(radius, 0.0, 2.0 * radius);
  double solid = 0.0, bulk = 0.0;
  for (const Quad& p : positions) {
    solid += sphere;
    bulk += volume_below(radius, p.z, high) - volume_below(radius, p.z, low);
    s.top = std::max(s.top, p.z + radius);
    for (int wall = 0; wall < kWalls; ++wall)
      s.wall_contacts += bin.has_wall(wall) && bin.distance(wall, p) < radius;
  }
  for_close_pairs(positions, bin, 2.0 * radius, [&](std::size_t a, std::size_t b, double distance) {
    const double lens = lens_volume(radius, distance), z = 0.5 * (positions[a].z + positions[b].z);
    ++s.pairs;
    solid -= lens;
    if (z > low && z < high) bulk -= lens;
    s.max_overlap = std::max(s.max_overlap, 2.0 * radius - distance);
  });
  s.coordination = 2.0 * static_cast<double>(s.pairs) / static_cast<double>(s.grains);
  s.solid_fraction = solid / (bin.length * bin.width * s.depth);
  s.solid_fraction_bulk = bulk / (bin.length * bin.width * (high - low));
  return s;
}

}  // namespace furrow::dem
