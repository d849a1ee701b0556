#include "terrain/dem/tires/surface_touch.hpp"

#include "protocol/core/assert.hpp"

namespace furrow::terrain::dem {

double spin_about(const SurfaceCollider& surface, int triangle, const Vec3& n) {
  FURROW_ASSERT(in_range(triangle, surface.mesh().triangles.size()), triangle, surface.mesh().triangles.size());
  const auto& t = surface.mesh().triangles[triangle];
  const auto x = surface.positions(), v = surface.velocities();
  const Vec3 ab = x[t[1]] - x[t[0]], ac = x[t[2]] - x[t[0]];
  const Vec3 twice_area = ab.cross(ac);
  const double area2 = twice_area.norm();
  if (area2 == 0.0) return 0.0;
  double circulation = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int a = t[k], b = t[(k + 1) % 3];
    circulation += 0.5 * (v[a] + v[b]).dot(x[b] - x[a]);
  }
  return circulation / area2 * (twice_area.dot(n) / area2);
}

}  // namespace furrow::terrain::dem
