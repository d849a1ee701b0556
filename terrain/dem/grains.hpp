// The state of all grains, one array per quantity, in the order of the strips that hold them.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// Bytes per grain: 3 × 32 + 4. `position` has kBeyond entries more, so that four can be read from any grain on.
struct Grains {
  static constexpr int kBeyond = 3;
  int count = 0;
  std::vector<Quad> position;    // m; w: radius, m
  std::vector<Quad> velocity;    // m/s
  std::vector<Quad> spin;        // rad/s
  std::vector<std::int32_t> id;  // 0 … count − 1 in order of generation

  void resize(int n) {
    FURROW_ASSERT(n >= 0, n);
    count = n;
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
