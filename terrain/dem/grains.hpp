// The state of all grains, one array per quantity, in the order of the strips that hold them.
#pragma once

#include <cstdint>
#include <vector>

#include "terrain/dem/lanes.hpp"

namespace furrow::dem {

/// Bytes per grain: 3 × 32 + 4.
struct Grains {
  int count = 0;
  std::vector<Quad> position;    // m
  std::vector<Quad> velocity;    // m/s
  std::vector<Quad> spin;        // rad/s
  std::vector<std::int32_t> id;  // 0 … count − 1 in order of generation

  void resize(int n) {
    count = n;
    for (auto* array : {&position, &velocity, &spin}) array->assign(n, Quad{});
    id.resize(n);
    for (int i = 0; i < n; ++i) id[i] = i;
  }
};

/// Contact forces and torques on one grain while a step is evaluated.
struct alignas(64) Load {
  Quad force;   // N
  Quad torque;  // N m
};

}  // namespace furrow::dem
