// Where a surface stands above or in the soil: for each node of the grid under it the lowest point of the surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/vec.hpp"

namespace furrow::terrain::scm {

/// Nodes at the middles of square cells: cell (i, j) at x = (i + ½) h, y = (j + ½ − ny/2) h.
struct Grid {
  int nx = 0, ny = 0;
  double spacing = 0.0;  // h, m

  /// As many cells as cover length × width. @pre all > 0
  static Grid over(double length, double width, double spacing);
  double x(int i) const { return (i + 0.5) * spacing; }
  double y(int j) const { return (j + 0.5 - 0.5 * ny) * spacing; }
  int index(int i, int j) const { return i * ny + j; }
  int count() const { return nx * ny; }
  std::array<int, 2> cell(int index) const { return {index / ny, index % ny}; }
  /// The first cell whose node is not below the coordinate.
  int first_x(double at) const;
  int first_y(double at) const;
};

/// A node under a surface.
struct NodeHit {
  int node = -1;
  int triangle = -1;
  std::array<double, 3> weight{};  // barycentric, of the point above the node
  double sinkage = 0.0;            // of the point below the undisturbed surface, straight down, m
  Vec3 push = Vec3::Zero();        // n/|n_z|, n the normal into the surface: force per pressure and area of a cell
};

/// Faces steeper than this do not press: the pressure of soil beside a surface is not modelled. |n_z| = cos 80°.
inline constexpr double kLeastVertical = 0.17364817766693033;

class FootprintFinder {
 public:
  /// @param ground heights of the undisturbed surface at the nodes, m; none: all are 0
  FootprintFinder(const Grid& grid, std::vector<double> ground);

  double ground(int node) const { return ground_.empty() ? 0.0 : ground_[node]; }
  /// Nodes under those faces that look down and reach below `height` (m) above the ground, in ascending order.
  void find(std::span<const std::array<int, 3>> triangles, std::span<const Vec3> position, double height,
            std::vector<NodeHit>& hits);

 private:
  void cover(int triangle, const std::array<Vec3, 3>& corner, double height);

  Grid grid_;
  std::vector<double> ground_;
  double top_ = 0.0;                // of the ground, m
  std::vector<std::int32_t> slot_;  // of each node: its place in found_ while find runs; −1: none
  std::vector<NodeHit> found_;
  std::array<int, 2> low_{}, high_{};  // the cells of all that is found: first and last along x and y
};

}  // namespace furrow::terrain::scm
