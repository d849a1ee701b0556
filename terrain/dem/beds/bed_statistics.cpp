#include "terrain/dem/beds/bed_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "protocol/core/assert.hpp"
#include "terrain/dem/beds/bed_height.hpp"
#include "terrain/dem/close_pairs.hpp"

namespace furrow::terrain::dem {

namespace {

constexpr int kLayers = std::tuple_size_v<decltype(BedStatistics::profile)>;

/// The middle of a bed, cut into layers.
class Middle {
 public:
  Middle(const Bin& bin, double depth, double radius) : low_(0.25 * depth), layer_(0.5 * depth / kLayers) {
    const auto margin = [&](bool periodic, double side) {
      return periodic ? 0.0 : std::min(kWallMargin * radius, 0.25 * side);
    };
    const double x = margin(bin.periodic_x, bin.length), y = margin(bin.periodic_y, bin.width);
    x_ = {x, bin.length - x, bin.periodic_x};
    y_ = {y - 0.5 * bin.width, 0.5 * bin.width - y, bin.periodic_y};
  }

  void add_grain(const Quad& p) {
    const double beside = x_.share(p.x, p.w) * y_.share(p.y, p.w);
    for (int k = 0; beside > 0.0 && k < kLayers; ++k)
      solid_[k] +=
          beside * (volume_below(p.w, p.z, low_ + (k + 1) * layer_) - volume_below(p.w, p.z, low_ + k * layer_));
  }
  /// Removes the volume that two grains both cover, about this point.
  void remove(double x, double y, double z, double volume) {
    const int k = static_cast<int>(std::floor((z - low_) / layer_));
    if (in_range(k, kLayers) && x_.holds(x) && y_.holds(y)) solid_[k] -= volume;
  }
  std::array<double, kLayers> fractions() const {
    std::array<double, kLayers> of = solid_;
    for (double& f : of) f /= (x_.to - x_.from) * (y_.to - y_.from) * layer_;
    return of;
  }

 private:
  struct Range {
    double from = 0.0, to = 0.0;
    bool all = false;  // periodic: images of grains that extend beyond one end enter at the other

    bool holds(double x) const { return all || (x >= from && x < to); }
    /// Share of a sphere's volume.
    double share(double x, double r) const {
      if (all) return 1.0;
      return (volume_below(r, x, to) - volume_below(r, x, from)) / volume_below(r, 0.0, r);
    }
  };
  double low_, layer_;
  Range x_, y_;
  std::array<double, kLayers> solid_{};
};

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

  Middle middle(bin, s.depth, radius);
  double solid = 0.0, largest = 0.0;
  for (const Quad& p : positions) {
    const double volume = volume_below(p.w, 0.0, 2.0 * p.w);
    solid += volume;
    s.grain_volume += volume;
    largest = std::max(largest, p.w);
    middle.add_grain(p);
    s.top = std::max(s.top, p.z + p.w);
    for (int wall = 0; wall < kWalls; ++wall) s.wall_contacts += bin.has_wall(wall) && bin.distance(wall, p) < p.w;
  }
  s.median_by_mass = median_by_mass(positions, s.grain_volume);
  const auto count_pair = [&](std::size_t a, std::size_t b, double distance) {
    const double overlap = positions[a].w + positions[b].w - distance;
    if (overlap <= 0.0) return;
    const double lens = lens_volume(positions[a].w, positions[b].w, distance);
    ++s.pairs;
    solid -= lens;
    const Quad &p = positions[a], &q = positions[b];
    middle.remove(0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z), lens);
    s.max_overlap = std::max(s.max_overlap, overlap);
  };
  for_close_pairs(positions, bin, 2.0 * largest, count_pair, progress);
  s.coordination = 2.0 * static_cast<double>(s.pairs) / static_cast<double>(s.grains);
  s.solid_fraction = solid / (bin.length * bin.width * s.depth);
  s.profile = middle.fractions();
  s.solid_fraction_bulk = std::accumulate(s.profile.begin(), s.profile.end(), 0.0) / s.profile.size();
  return s;
}

}  // namespace furrow::terrain::dem
