// Sums over forces on the vertices of a surface.
#pragma once

#include "protocol/core/surface.hpp"

namespace furrow::test {

/// Sum of the forces, N.
inline Vec3 sum(const NodalForces& f) {
  Vec3 force = Vec3::Zero();
  for (const Vec3& one : f.force) force += one;
  return force;
}
/// Sum of the moments, N m.
inline Vec3 moment_about(const Vec3& centre, const NodalForces& f, const SurfaceState& surface) {
  Vec3 moment = Vec3::Zero();
  for (std::size_t k = 0; k < f.vertex.size(); ++k)
    moment += (surface.position[f.vertex[k]] - centre).cross(f.force[k]);
  return moment;
}

}  // namespace furrow::test
