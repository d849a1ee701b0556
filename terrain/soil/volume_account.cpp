#include "terrain/soil/volume_account.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSpacing = 0.5;     // of the grid points, radii
constexpr double kMostPoints = 3e8;  // with more points the spacing is widened
constexpr std::uint8_t kAny = 0, kHull = 1, kSolid = 2;

/// Points on a grid over the region, from the floor up.
class Points {
 public:
  Points(const Region& region, double top, double spacing) : region_(region) {
    const auto divide = [&](double length) { return std::max(1, static_cast<int>(std::ceil(length / spacing))); };
    nx_ = divide(region.x_max - region.x_min), ny_ = divide(region.y_max - region.y_min), nz_ = divide(top);
    dx_ = (region.x_max - region.x_min) / nx_, dy_ = (region.y_max - region.y_min) / ny_, dz_ = top / nz_;
    marks_.assign(static_cast<std::size_t>(nx_) * ny_ * nz_, 0);
  }

  /// Marks the points within a grain, and those within `reach` of one.
  void mark(std::span<const dem::Quad> grains, double reach) {
    std::fill(marks_.begin(), marks_.end(), 0);
    const double length = region_.x_max - region_.x_min, width = region_.y_max - region_.y_min;
    for (const dem::Quad& p : grains)
      for (int i = region_.periodic_x ? -1 : 0; i <= (region_.periodic_x ? 1 : 0); ++i)
        for (int j = region_.periodic_y ? -1 : 0; j <= (region_.periodic_y ? 1 : 0); ++j)
          mark_one({p.x + i * length - region_.x_min, p.y + j * width - region_.y_min, p.z, p.w}, p.w + reach);
  }

  /// Volume of the points with this mark, or of all with kAny, for which inside(x, y, z) holds, m³.
  template <class Inside>
  double volume(std::uint8_t mark, const Inside& inside) const {
    std::int64_t count = 0;
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < ny_; ++j) {
        const double x = region_.x_min + (i + 0.5) * dx_, y = region_.y_min + (j + 0.5) * dy_;
        const std::uint8_t* column = &marks_[(static_cast<std::size_t>(i) * ny_ + j) * nz_];
        for (int k = 0; k < nz_; ++k)
          count += (mark == kAny || (column[k] & mark) != 0) && inside(x, y, (k + 0.5) * dz_);
      }
    return static_cast<double>(count) * dx_ * dy_ * dz_;
  }

 private:
  /// @param p relative to the corner of the region
  void mark_one(const dem::Quad& p, double reach) {
    const auto first = [](double at, double step) { return std::max(0, static_cast<int>(std::ceil(at / step - 0.5))); };
    const auto last = [](double at, double step, int n) {
      return std::min(n - 1, static_cast<int>(std::floor(at / step - 0.5)));
    };
    for (int i = first(p.x - reach, dx_), i_end = last(p.x + reach, dx_, nx_); i <= i_end; ++i)
      for (int j = first(p.y - reach, dy_), j_end = last(p.y + reach, dy_, ny_); j <= j_end; ++j) {
        const double x = (i + 0.5) * dx_ - p.x, y = (j + 0.5) * dy_ - p.y, across = x * x + y * y;
        if (across > reach * reach) continue;
        const double half = std::sqrt(reach * reach - across);
        std::uint8_t* column = &marks_[(static_cast<std::size_t>(i) * ny_ + j) * nz_];
        for (int k = first(p.z - half, dz_), k_end = last(p.z + half, dz_, nz_); k <= k_end; ++k) {
          const double z = (k + 0.5) * dz_ - p.z;
          column[k] |= across + z * z <= p.w * p.w ? kHull | kSolid : kHull;
        }
      }
  }

  Region region_;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  double dx_ = 0.0, dy_ = 0.0, dz_ = 0.0;
  std::vector<std::uint8_t> marks_;  // [(ix * ny + iy) * nz + iz]
};

/// Calls visit(height before, height after, share of the cell outside the plate, its area) for the region's cells.
template <class Visit>
void each_cell(const Region& region, const Footprint& plate, const HeightField& before, const HeightField& after,
               const Visit& visit) {
  constexpr int kParts = 8;  // of a cell's side, to find the part that the plate covers
  FURROW_ASSERT(before.nx == after.nx && before.ny == after.ny, before.nx, after.nx);
  for (int i = 0; i < before.nx; ++i)
    for (int j = 0; j < before.ny; ++j) {
      const double x = before.x0 + i * before.cell, y = before.y0 + j * before.cell, half = 0.5 * before.cell;
      if (x < region.x_min || x > region.x_max || y < region.y_min || y > region.y_max) continue;
      // The last cell of a row extends to the end of the bed, if it reaches it.
      const double right = i + 1 == before.nx ? std::max(x + half, region.x_max) : x + half;
      const double left = j + 1 == before.ny ? std::max(y + half, region.y_max) : y + half;
      const double dx = (right - x + half) / kParts, dy = (left - y + half) / kParts;
      int free = 0;
      for (int a = 0; a < kParts; ++a)
        for (int b = 0; b < kParts; ++b) free += !plate.covers(x - half + (a + 0.5) * dx, y - half + (b + 0.5) * dy);
      const std::size_t at = static_cast<std::size_t>(i) * before.ny + j;
      if (std::isnan(before.height[at]) || std::isnan(after.height[at])) continue;
      visit(before.height[at], after.height[at], free / double{kParts * kParts}, kParts * kParts * dx * dy);
    }
}

}  // namespace

bool Footprint::covers(double px, double py) const {
  const double across = disc ? std::hypot(px - x, py - y) : std::abs(px - x);
  return across < 0.5 * size;
}

VolumeAccount volume_account(const Region& region, const Footprint& plate, double area, double sinkage, double face,
                             const BedState& before, const BedState& after, double radius) {
  FURROW_ASSERT(region.x_min < region.x_max && region.y_min < region.y_max, region.x_min, region.y_min);
  FURROW_ASSERT(radius > 0.0 && plate.size > 0.0 && area > 0.0, radius, plate.size, area);
  VolumeAccount account;
  account.displaced = area * sinkage;
  double heights = 0.0, cells = 0.0;  // m³, m²
  each_cell(region, plate, before.surface, after.surface, [&](double h, double later, double free, double cell) {
    account.heaved += free * cell * (later - h);
    heights += cell * h, cells += cell;
  });

  double top = 0.0;
  for (const auto& grains : {before.grains, after.grains})
    for (const dem::Quad& p : grains) top = std::max(top, p.z + p.w + radius);
  const double ground = (region.x_max - region.x_min) * (region.y_max - region.y_min);
  Points points(region, top, std::max(kSpacing * radius, std::cbrt(ground * top / kMostPoints)));
  const auto outside_plate = [&](double x, double y, double z) { return z < face || !plate.covers(x, y); };
  // Grains are packed more loosely along a flat face, within their diameter of it, whatever the soil.
  const double high = face - 2.0 * radius, deep = std::max(0.0, high - plate.size);
  const auto below = [&](double x, double y, double z) { return z > deep && z < high && plate.covers(x, y); };
  const double space = points.volume(kAny, below);

  points.mark(before.grains, radius);
  const double bulk = points.volume(kHull, [](double, double, double) { return true; });
  account.solid_before = points.volume(kSolid, below) / space;
  points.mark(after.grains, radius);
  const double later = points.volume(kHull, outside_plate);
  account.solid_after = points.volume(kSolid, below) / space;
  const double offset = bulk / ground - heights / cells;  // δ
  account.compacted = bulk - later - offset * area;
  return account;
}

}  // namespace furrow::terrain::soil
