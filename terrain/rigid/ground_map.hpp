// Hard ground whose height z(x, y) is given on a grid, straight between neighbouring nodes along x and along y.
//
// As of a profile (ground_profile.hpp) the ground is an elastic layer under a skin of this shape, with a pressure field
// that is fixed in it [Elandt et al. 2019]. At a point inside, d is its depth under the skin's tangent plane above it,
//   p = κ d,   d = (h(x, y) − z) c,   c = 1/√(1 + h_x² + h_y²),                                                (1)
// which is the distance to the skin where that is plane. Over the column above the point ∫ d dz' = d²/(2 c), so the
// energy of the contact is
//   E = κ ∫ d dV = κ ∮ d²/(2 c) (−n_z) dA.                                                                     (2)
// Height maps have no upright faces; the pressure acts along the surface's own normal, in all three directions.
//
// The grid may lie along a line that turns (road_line.hpp): h is then straight between nodes along u and along v.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "protocol/core/terrain_state.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/rigid/ground_pressure.hpp"
#include "terrain/rigid/road_line.hpp"

namespace furrow::terrain {

/// Heights at the nodes of a grid, m.
struct HeightMap {
  std::vector<double> x, y;                   // of the nodes, rising, two at least, m; with a line: u and v along it
  std::vector<double> z;                      // [ix * y.size() + iy], finite
  double turn = 0.0;                          // of the line that is laid straight along x, rad
  std::shared_ptr<const RoadLine> line = {};  // none: the grid lies along x and y
};

/// The least and the largest x, then y, m.
std::array<double, 4> extent(const HeightMap& map);

class GroundMap {
 public:
  /// @pre map is as HeightMap says
  explicit GroundMap(HeightMap map);

  /// Beyond the grid that of its border.
  double height(double x, double y) const;
  /// c of (1).
  double cosine(double x, double y) const;
  double depth(const Vec3& at) const;  // d of (1), m; 0 where the point is not in the ground
  double highest(double x_from, double x_to, double y_from, double y_to) const;
  double mean(double x_from, double x_to, double y_from, double y_to) const;  // @pre from ≤ to
  HeightField field() const;                                                  // for pictures

  /// Integration points of the part of triangle x in the ground: cut into up to 64 equal parts, as fine as the grid,
  /// each exact for heights that are linear over it. Areas are those of the triangle itself. Returns how many.
  int points(const std::array<Vec3, 3>& x, ProfilePointList& out) const;

 private:
  struct Cell {
    std::size_t ix, iy;  // of its first node
    double sx, sy;       // share of the way to the next
    bool inside_x, inside_y;
  };
  /// A rectangle of the grid.
  struct Range {
    double x_from, x_to, y_from, y_to;
  };
  RoadLine::Place place(double x, double y, std::size_t near) const;
  Cell cell_at(const RoadLine::Place& at) const;
  double height(const RoadLine::Place& at) const;
  double cosine(const RoadLine::Place& at) const;
  Range range_of(std::span<const RoadLine::Place> corners) const;
  double highest(const Range& range) const;
  double at(std::size_t ix, std::size_t iy) const { return map_.z[ix * map_.y.size() + iy]; }

  HeightMap map_;
  double top_;  // highest node, m
};

}  // namespace furrow::terrain
