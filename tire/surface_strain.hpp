// Strain of a tire's contact surface, of its triangles. With the metric tensors G and g of a triangle's two edges
// before and after, the in-plane Green–Lagrange strain has the principal values of ½ G⁻¹ (g − G) [Holzapfel 2000,
// Nonlinear Solid Mechanics, 2.5].
#pragma once

#include <vector>

#include "protocol/core/surface.hpp"

namespace furrow::tire {

/// Returns the larger principal strain at each vertex: the mean over the triangles around it, by their undeformed area.
/// @pre one position for each vertex in both; no triangle of `undeformed` is degenerate
std::vector<float> surface_strain(const SurfaceMesh& mesh, const std::vector<Vec3>& undeformed,
                                  const std::vector<Vec3>& position);

}  // namespace furrow::tire
