// A surface that moves on a terrain, with the work and impulse on it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "protocol/core/archive_hash.hpp"
#include "terrain/terrain.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {

struct PressedSurface {
  testing::Surface shape;
  SurfaceState state = testing::at_rest(shape);
  std::vector<NodalForces> forces{1};
  std::vector<ContactSums> sums{1};
  double work = 0.0, hardest = 0.0, elapsed = 0.0;  // J, N upward, s
  Vec3 impulse = Vec3::Zero();                      // N s

  /// @returns the first failure
  Outcome move(Terrain& terrain, const Vec3& velocity, int intervals, double duration, int substeps = 1) {
    for (int k = 0; k < intervals; ++k) {
      std::fill(state.velocity.begin(), state.velocity.end(), velocity);
      if (Outcome outcome = terrain.advance({&state, 1}, duration, substeps, forces, sums); !outcome.ok) return outcome;
      for (Vec3& x : state.position) x += duration * velocity;
      work += sums[0].work;
      impulse += duration * sums[0].force;
      hardest = std::max(hardest, sums[0].force.z());
      elapsed += duration;
    }
    return {};
  }
};

inline std::uint64_t hash_of(const Terrain& terrain) {
  Archive archive;
  terrain.save(archive);
  return archive_hash(archive).value();
}

}  // namespace furrow::terrain
