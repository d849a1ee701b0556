// The force of hard ground on a surface within one interval.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "terrain/rigid/rigid_ground.hpp"
#include "tests/nodal_sums.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {

inline ContactMaterial rubber(double friction = 0.8) {
  ContactMaterial material;
  material.friction = friction;
  return material;
}

struct Push {
  NodalForces forces;
  ContactSums sums;
};

/// Ground with a surface on it.
inline std::unique_ptr<Terrain> ground_under(const testing::Surface& surface, const SurfaceState& start,
                                             const GroundOptions& options = {}, double friction = 0.8) {
  auto ground = make_rigid_ground(options);
  ground->attach(surface.mesh, rubber(friction), start);
  return ground;
}

/// Result of one interval of a surface that begins at `start` and moves with constant velocity.
inline Push push(Terrain& ground, const SurfaceState& start, double duration = 1e-6, int substeps = 1) {
  Push result;
  const Outcome status = ground.advance({&start, 1}, duration, substeps, {&result.forces, 1}, {&result.sums, 1});
  EXPECT_TRUE(status.ok) << status.message("terrain");
  return result;
}

}  // namespace furrow::terrain
