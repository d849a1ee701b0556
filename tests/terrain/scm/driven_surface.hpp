// A rigid surface that moves over empirical soil with given velocities.
#pragma once

#include <gtest/gtest.h>

#include "terrain/scm/scm_ground.hpp"
#include "tests/nodal_sums.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::testing {

struct DrivenSurface {
  Surface surface;
  Vec3 position = Vec3::Zero();  // of its origin, m
  double turn = 0.0;             // about +y, rad
  NodalForces forces{};          // of the last interval
  ContactSums sums{};

  SurfaceState state(const Vec3& velocity = Vec3::Zero(), double spin = 0.0) const {
    return placed(surface, position, velocity, turn, spin);
  }
  void attach(terrain::Terrain& ground, double friction) const {
    ContactMaterial material;
    material.friction = friction;
    ground.attach(surface.mesh, material, state());
  }
  /// Moves by one interval.
  void move(terrain::Terrain& ground, const Vec3& velocity, double spin, double dt, int substeps = 1) {
    const SurfaceState start = state(velocity, spin);
    const Outcome outcome = ground.advance({&start, 1}, dt, substeps, {&forces, 1}, {&sums, 1});
    ASSERT_TRUE(outcome.ok) << outcome.message("terrain");
    position += dt * velocity;
    turn += dt * spin;
  }
  /// Moment of the last interval's forces about the axle, N m.
  Vec3 moment() const { return test::moment_about(position, forces, state()); }
};

/// Residual of the accounts since the beginning, J.
inline double residual(const terrain::Terrain& ground) {
  const TerrainEnergies e = ground.gather_state().energies;
  return e.stored() + e.losses() - e.surface_work - e.wall_work;
}

}  // namespace furrow::testing
