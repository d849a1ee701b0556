// Broad phase of SurfaceCollider: finds the triangles that may be within `reach + skin` of a point.
//
// A uniform grid over the triangles' boxes. Every triangle is listed in each cell that it may reach, so a query reads
// one cell. Lists are in triangle order, so the order of results does not depend on when the grid was built.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/vec.hpp"

namespace furrow::terrain {

class SurfaceGrid {
 public:
  /// @param margin  a point finds every triangle within this distance, m (> 0)
  void build(std::span<const Vec3> vertex, std::span<const std::array<int, 3>> triangle, std::span<const int> listed,
             double margin);

  /// Its contents, for another device: cell (x, y, z) has the number (x ny + y) nz + z.
  const Vec3& origin() const { return origin_; }
  double inverse_cell() const { return inverse_cell_; }
  const std::array<int, 3>& cells() const { return cells_; }
  std::span<const std::int32_t> first() const { return first_; }
  std::span<const int> entries() const { return entry_; }

  /// Candidates for a point; empty outside the grid.
  std::span<const int> candidates(const Vec3& point) const {
    const double x = (point.x() - origin_.x()) * inverse_cell_;
    const double y = (point.y() - origin_.y()) * inverse_cell_;
    const double z = (point.z() - origin_.z()) * inverse_cell_;
    if (!(x >= 0.0 && y >= 0.0 && z >= 0.0 && x < cells_[0] && y < cells_[1] && z < cells_[2])) return {};
    const std::size_t cell = (static_cast<std::size_t>(x) * cells_[1] + static_cast<std::size_t>(y)) * cells_[2] +
                             static_cast<std::size_t>(z);
    return {entry_.data() + first_[cell], static_cast<std::size_t>(first_[cell + 1] - first_[cell])};
  }

 private:
  void size_cells(const Vec3& extent, double margin);
  template <class Visit>
  void visit_cells(const Vec3& a, const Vec3& b, const Vec3& c, double margin, Visit&& visit) const;

  Vec3 origin_ = Vec3::Zero();       // m
  double cell_ = 1.0;                // edge length, m
  double inverse_cell_ = 1.0;        // 1/m
  std::array<int, 3> cells_{};       // per axis
  std::vector<std::int32_t> first_;  // cell → its first entry
  std::vector<int> entry_;           // triangles, ascending within a cell
};

}  // namespace furrow::terrain
