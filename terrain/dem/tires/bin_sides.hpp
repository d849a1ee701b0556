// Where surfaces may stand in the bin.
#pragma once

#include "terrain/dem/bin.hpp"
#include "terrain/surface/surface_collider.hpp"

namespace furrow::terrain::dem {

/// The side of the bin that the box crosses, or null. Surfaces may stand out of periodic sides; they have no images, so
/// one that acts there spans the whole side.
inline const char* side_crossed(const Bin& bin, const SurfaceBox& box) {
  if (!bin.periodic_x && !(box.lo.x() >= 0.0)) return "the wall x = 0";
  if (!bin.periodic_x && !(box.hi.x() <= bin.length)) return "the wall x = length";
  if (!bin.periodic_y && !(box.lo.y() >= -0.5 * bin.width)) return "the wall y = -width/2";
  if (!bin.periodic_y && !(box.hi.y() <= 0.5 * bin.width)) return "the wall y = width/2";
  if (!(box.lo.z() >= 0.0)) return "the floor";
  return nullptr;
}

}  // namespace furrow::terrain::dem
