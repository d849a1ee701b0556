#include "terrain/surface/surface_grid.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr double kMaxCells = 1e6;
constexpr double kCellShare = 2.0;  // cell / margin: a larger cell means longer lists per query and fewer cells to fill

}  // namespace

void SurfaceGrid::size_cells(const Vec3& extent, double margin) {
  FURROW_ASSERT(margin > 0.0 && !(extent.minCoeff() < 0.0), margin, extent.minCoeff());
  cell_ = kCellShare * margin;
  auto count = [&](int axis) { return std::floor(extent[axis] / cell_) + 1.0; };
  while (count(0) * count(1) * count(2) > kMaxCells) cell_ *= 1.25;
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<int>(count(axis));
  inverse_cell_ = 1.0 / cell_;
}

/// Calls visit(cell) for every cell that has a point within `margin` of the triangle, and possibly for some others.
template <class Visit>
void SurfaceGrid::visit_cells(const Vec3& a, const Vec3& b, const Vec3& c, double margin, Visit&& visit) const {
  const Vec3 lo = a.cwiseMin(b).cwiseMin(c).array() - margin;
  const Vec3 hi = a.cwiseMax(b).cwiseMax(c).array() + margin;
  std::array<int, 3> from{}, to{};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = cells_[axis] - 1;
    from[axis] = static_cast<int>(std::clamp(std::floor((lo[axis] - origin_[axis]) * inverse_cell_), 0.0, last));
    to[axis] = static_cast<int>(std::clamp(std::floor((hi[axis] - origin_[axis]) * inverse_cell_), 0.0, last));
  }
  const Vec3 cross = (b - a).cross(c - a);
  const double length = cross.norm();
  const Vec3 normal = length > 0.0 ? Vec3(cross / length) : Vec3::Zero();
  // A cell is too far if its centre is farther from the plane than margin + the cell's extent along the normal.
  const double limit = margin + 0.5 * cell_ * normal.lpNorm<1>() * (1.0 + 1e-9);
  for (int ix = from[0]; ix <= to[0]; ++ix)
    for (int iy = from[1]; iy <= to[1]; ++iy)
      for (int iz = from[2]; iz <= to[2]; ++iz) {
        const Vec3 centre = origin_ + cell_ * Vec3(ix + 0.5, iy + 0.5, iz + 0.5);
        if (std::abs(normal.dot(centre - a)) > limit) continue;
        visit((static_cast<std::size_t>(ix) * cells_[1] + iy) * cells_[2] + iz);
      }
}

void SurfaceGrid::build(std::span<const Vec3> vertex, std::span<const std::array<int, 3>> triangle,
                        std::span<const int> listed, double margin) {
  FURROW_ASSERT(margin > 0.0, margin);
  FURROW_ASSERT(std::all_of(listed.begin(), listed.end(), [&](int t) { return in_range(t, triangle.size()); }),
                triangle.size());
  cells_ = {0, 0, 0};
  first_.assign(1, 0);
  entry_.clear();
  if (listed.empty()) return;

  Vec3 lo = vertex[triangle[listed[0]][0]], hi = lo;
  for (int t : listed)
    for (int v : triangle[t]) {
      lo = lo.cwiseMin(vertex[v]);
      hi = hi.cwiseMax(vertex[v]);
    }
  origin_ = lo.array() - margin;
  size_cells(hi - lo + Vec3::Constant(2.0 * margin), margin);

  const std::size_t cells = static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2];
  first_.assign(cells + 1, 0);
  auto for_each_entry = [&](auto&& visit) {
    for (int t : listed)
      visit_cells(vertex[triangle[t][0]], vertex[triangle[t][1]], vertex[triangle[t][2]], margin,
                  [&](std::size_t cell) { visit(cell, t); });
  };
  for_each_entry([&](std::size_t cell, int) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell < cells; ++cell) first_[cell + 1] += first_[cell];
  entry_.resize(first_[cells]);
  // Filling moves first_[cell] to the cell's end; shifting by one cell restores the beginnings.
  for_each_entry([&](std::size_t cell, int t) { entry_[first_[cell]++] = t; });
  for (std::size_t cell = cells; cell > 0; --cell) first_[cell] = first_[cell - 1];
  first_[0] = 0;
}

}  // namespace furrow::terrain
