// Undeformed geometry of a tire in rim axes (origin at the rim centre, y the spin axis): a meridian of nodes turned
// around the axis, and the closed triangulated contact surface on it. All models that use a shell tire file share it.
//
// Node (i, j): column i of the circumference at angle θ_i = 2πi/n_c, row j of the width from the left (−y)
// bead.
//   e_r(θ) = (sin θ, 0, cos θ),  e_t = ∂e_r/∂θ,  e_t × e_y = e_r: circumference × width = outward normal.
#pragma once

#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/surface.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

struct ShellMesh {
  int columns = 0;             // elements around, n_c
  int rows = 0;                // node rows across = elements across + 1
  std::vector<Vec3> position;  // of the rows of column 0, m
  std::vector<Vec3> director;  // outward unit normals there

  int elements_width() const { return rows - 1; }
  int nodes() const { return columns * rows; }
  int node(int i, int j) const {
    FURROW_ASSERT(in_range(i, columns) && in_range(j, rows), i, columns, j, rows);
    return i * rows + j;
  }
  double pitch() const;    // angle between columns, rad
  Mat3 turn(int i) const;  // from column 0 to column i
  Vec3 node_position(int i, int j) const { return turn(i) * position[j]; }
  /// Centre of the disc that closes the left (side 0) or right (side 1) bead, m.
  Vec3 disc_centre(int side) const;
};

/// Nodes at t = j / elements of the profile's natural cubic splines x(t), y(t).
/// @throws Error(bad_input) when the profile folds back or passes through the axis.
ShellMesh make_shell_mesh(const TireFile& file);

/// Vertices: the nodes, then the two disc centres. Each quad is split into two triangles, mirrored about the
/// mid-plane.
SurfaceMesh make_surface_mesh(const ShellMesh& mesh);

/// Consistent mass of one element of each width position: entries (2n + s) with corner n (counter-clockwise
/// from (i, j)) and s = 0 for positions (kg), 1 for directors (kg m); the same for every Cartesian component.
///   M = ∫ ρ(z) [1 z; z z²] N Nᵀ j(ξ, η, z) dξ dη dz,  r = Σ N (r_n + z d_n)
using ElementMass = Eigen::Matrix<double, 8, 8>;
std::vector<ElementMass> element_masses(const TireFile& file, const ShellMesh& mesh);

/// Rigid-body mass and inertia of the mass matrix: its action on rigid motions of the undeformed tire.
MassProperties rigid_mass(const ShellMesh& mesh, const std::vector<ElementMass>& masses);

/// Axial extent of the tread section's mid-surface, m.
double tread_width(const TireFile& file, const ShellMesh& mesh);

}  // namespace furrow::tire
