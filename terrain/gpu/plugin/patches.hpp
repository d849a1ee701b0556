// The patches of a surface (terrain/surface/surface_patches.hpp) in the arrays of the GPU.
#pragma once

#include "terrain/gpu/plugin/device.hpp"
#include "terrain/surface/facets.hpp"
#include "terrain/surface/patch_turn.hpp"

namespace furrow::terrain::gpu {

/// The vertices of a triangle's patch at their present positions.
struct Patch {
  Vector centre, spin;  // m, rad/s
  Symmetric inverse;    // 1/m²
};

struct Patches {
  const i32 *first, *vertex;
  const double *position, *velocity;

  FURROW_HD PatchVertices vertices(i32 t) const { return {vertex + first[t], first[t + 1] - first[t], position}; }
  FURROW_HD Patch of(i32 t) const {
    const PatchVertices v = vertices(t);
    const Vector centre = v.centre();
    const Symmetric inverse = v.inverse(centre);
    return {centre, v.spin(centre, inverse, velocity), inverse};
  }
  /// J⁻¹ b
  FURROW_HD Vector solved(i32 t, const Patch& patch, const Vector& b) const {
    return vertices(t).solved(patch.centre, patch.inverse, b);
  }
};

}  // namespace furrow::terrain::gpu
