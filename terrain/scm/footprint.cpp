#include "terrain/scm/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {
namespace {

// A node on the edge between two triangles belongs to both; the lower one counts, the first of equals.
constexpr double kEdge = -1e-9;
constexpr double kWhole = 1e-9;  // of a cell: what round-off may add to a length

/// First k with (k + ½) h ≥ at, not below 0 and not beyond count.
int first_at(double at, double spacing, int count) {
  const double k = std::ceil(at / spacing - 0.5);
  return static_cast<int>(std::clamp(k, 0.0, static_cast<double>(count)));
}

}  // namespace

Grid Grid::over(double length, double width, double spacing) {
  FURROW_ASSERT(length > 0.0 && width > 0.0 && spacing > 0.0, length, width, spacing);
  Grid grid;
  grid.spacing = spacing;
  grid.nx = std::max(1, static_cast<int>(std::ceil(length / spacing - kWhole)));
  grid.ny = std::max(1, static_cast<int>(std::ceil(width / spacing - kWhole)));
  return grid;
}

int Grid::first_x(double at) const { return first_at(at, spacing, nx); }
int Grid::first_y(double at) const { return first_at(at + 0.5 * ny * spacing, spacing, ny); }

FootprintFinder::FootprintFinder(const Grid& grid, std::vector<double> ground)
    : grid_(grid), ground_(std::move(ground)), slot_(grid.count(), -1) {
  FURROW_ASSERT(ground_.empty() || ground_.size() == slot_.size(), ground_.size(), slot_.size());
  if (!ground_.empty()) top_ = *std::max_element(ground_.begin(), ground_.end());
}

void FootprintFinder::find(std::span<const std::array<int, 3>> triangles, std::span<const Vec3> position, double height,
                           std::vector<NodeHit>& hits) {
  found_.clear();
  low_ = {grid_.nx, grid_.ny}, high_ = {-1, -1};
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const auto& v = triangles[t];
    const std::array<Vec3, 3> corner{position[v[0]], position[v[1]], position[v[2]]};
    if (std::min({corner[0].z(), corner[1].z(), corner[2].z()}) < top_ + height) cover(t, corner, height);
  }
  hits.clear();
  for (int i = low_[0]; i <= high_[0]; ++i)
    for (int j = low_[1]; j <= high_[1]; ++j) {
      std::int32_t& slot = slot_[grid_.index(i, j)];
      if (slot >= 0) hits.push_back(found_[std::exchange(slot, -1)]);
    }
}

void FootprintFinder::cover(int triangle, const std::array<Vec3, 3>& corner, double height) {
  const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0], outward = ab.cross(ac);
  if (!(outward.z() < -kLeastVertical * outward.norm())) return;
  const Vec3 push = outward / outward.z();  // its z is 1: into the surface
  const auto [x_low, x_high] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
  const auto [y_low, y_high] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
  const double slack = 1e-9 * grid_.spacing;
  const int i_end = grid_.first_x(x_high + slack), j_end = grid_.first_y(y_high + slack);
  const int j_begin = grid_.first_y(y_low - slack);
  for (int i = grid_.first_x(x_low - slack); i < i_end; ++i)
    for (int j = j_begin; j < j_end; ++j) {
      const double dx = grid_.x(i) - corner[0].x(), dy = grid_.y(j) - corner[0].y();
      const double v = (dx * ac.y() - dy * ac.x()) / outward.z(), w = (ab.x() * dy - ab.y() * dx) / outward.z();
      if (!(v >= kEdge && w >= kEdge && v + w <= 1.0 - kEdge)) continue;
      const double z = corner[0].z() + v * ab.z() + w * ac.z();
      const int node = grid_.index(i, j);
      const double sinkage = ground(node) - z;
      if (!(sinkage > -height)) continue;
      if (slot_[node] < 0) {
        slot_[node] = static_cast<std::int32_t>(found_.size());
        found_.push_back({node, triangle, {1.0 - v - w, v, w}, sinkage, push});
        low_ = {std::min(low_[0], i), std::min(low_[1], j)};
        high_ = {std::max(high_[0], i), std::max(high_[1], j)};
      } else if (NodeHit& other = found_[slot_[node]]; sinkage > other.sinkage) {
        other = {node, triangle, {1.0 - v - w, v, w}, sinkage, push};
      }
    }
}

}  // namespace furrow::terrain::scm
