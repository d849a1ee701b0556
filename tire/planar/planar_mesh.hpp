// Meshes of triangles for a wheel seen from its right side: a disc and, around it, an annulus, the tire. Both share the
// nodes of the disc's rim. x forward, z up, origin at the axle; triangles run counter-clockwise in (x, z).
//
// Nodes lie on rings. Rings of the annulus have equally many nodes, and each is turned by half a step against the next.
// So triangles are isosceles and a mesh is its own mirror image. Rings of the disc have about six nodes less with each
// ring towards the middle. The outermost ring has a node at the lowest point.
#pragma once

#include <array>
#include <vector>

#include "tire/extruded/plane_vectors.hpp"

namespace furrow::tire {

struct PlanarMesh {
  PlanarField position;                       // undeformed, m
  std::vector<std::array<int, 3>> triangles;  // nodes, counter-clockwise
  std::vector<int> part;                      // of each triangle: its material
  std::vector<int> outer, inner;              // nodes of the two edges, counter-clockwise; a disc has no inner edge
  std::vector<int> rim;                       // of a wheel: nodes that disc and tire share, counter-clockwise
  int centre = -1;                            // node at the axle; −1: none

  int nodes() const { return static_cast<int>(position.size()); }
  int elements() const { return static_cast<int>(triangles.size()); }
};

/// @param shift turns the outer ring by this share of a step. @pre radius > 0, around ≥ 6
PlanarMesh planar_disc(double radius, int around, double shift = 0.0);

/// Largest number of rings: the rings' curvature makes triangles flatter, here to a tenth of their height. With more
/// rings they would overlap.
int planar_most_rings(double inner, double outer, int around);

/// @param rings of elements between the radii. @pre 0 < inner < outer, 1 ≤ rings ≤ planar_most_rings(), around ≥ 6
PlanarMesh planar_annulus(double inner, double outer, int rings, int around);

/// Merges two meshes: the outer nodes of the disc are the inner nodes of the annulus. The parts of the annulus are
/// numbered after the parts of the disc.
/// @pre those nodes coincide, in order
PlanarMesh merged(const PlanarMesh& disc, const PlanarMesh& annulus);

struct PlanarWheelSize {
  double radius = 0.0, rim_radius = 0.0;  // m
  int rings = 0, around = 0;              // elements through the tire, and along each of its rings
};

/// Disc (part 0) and tire (part 1). @pre as for planar_disc() and planar_annulus()
PlanarMesh planar_wheel(const PlanarWheelSize& size);

}  // namespace furrow::tire
