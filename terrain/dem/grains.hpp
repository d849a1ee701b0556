// The state of all grains, one array per quantity, in the order of the strips that hold them.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Σ w v of one grain over the window of its parcel so far, m/s (activity.hpp).
struct alignas(16) Drift {
  float x = 0.0F, y = 0.0F, z = 0.0F;
};

/// Bytes per grain: 3 × 32 + 4, and 16 more if grains may sleep. `position` has kBeyond entries more, so that four can
/// be read starting at any grain.
struct Grains {
  static constexpr int kBeyond = 3;
  int count = 0;
  std::vector<Quad> position;    // m; w: radius, m
  std::vector<Quad> velocity;    // m/s
  std::vector<Quad> spin;        // rad/s
  std::vector<std::int32_t> id;  // 0 … count − 1 in order of generation
  std::vector<Drift> drift;      // empty if no grain may sleep

  void resize(int n, bool may_sleep = false) {
    FURROW_ASSERT(n >= 0, n);
    count = n;
    drift.assign(may_sleep ? n : 0, Drift{});
    position.assign(n + kBeyond, Quad{});
    velocity.assign(n, Quad{});
    spin.assign(n, Quad{});
    id.resize(n);
    for (int i = 0; i < n; ++i) id[i] = i;
  }
};

/// Contact forces (N) and torques (N m) on consecutive grains while a step is evaluated.
struct Loads {
  Quad* force = nullptr;
  Quad* torque = nullptr;

  Loads from(int grain) const { return {force + grain, torque + grain}; }
};

}  // namespace furrow::terrain::dem
