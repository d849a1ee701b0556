// Allowed places of surfaces in the bin.
#pragma once

#include "terrain/dem/bin.hpp"
#include "terrain/surface/surface_collider.hpp"

namespace furrow::terrain::dem {

/// The side of the bin that the box crosses, or null. Surfaces may extend beyond periodic sides. They have no images,
/// so a surface that acts there spans the whole side.
inline const char* side_crossed(const Bin& bin, const SurfaceBox& box) {
  for (int wall = 0; wall < kWalls; ++wall) {
    const Vec3& x = Bin::normal(wall).x < 0.0 || Bin::normal(wall).y < 0.0 ? box.hi : box.lo;
    if (bin.has_wall(wall) && !(bin.distance(wall, Quad{x.x(), x.y(), x.z()}) >= 0.0)) return Bin::name(wall);
  }
  return nullptr;
}

}  // namespace furrow::terrain::dem
