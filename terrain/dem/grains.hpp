// The state of all grains, one array per quantity, in the order of the broad-phase grid.
#pragma once

#include <cstdint>
#include <vector>

#include "terrain/dem/lanes.hpp"

namespace furrow::dem {

/// Bytes per grain: 6 × 32 + 4. Each array has one entry more than there are grains: a stranger far away, the
/// partner of padding pairs, which never touches anything.
struct Grains {
  int count = 0;
  std::vector<Quad> position;    // m
  std::vector<Quad> velocity;    // m/s
  std::vector<Quad> spin;        // rad/s
  std::vector<Quad> force;       // of contacts, N
  std::vector<Quad> torque;      // of contacts, N m
  std::vector<Quad> listed_at;   // position when its neighbours were listed, m
  std::vector<std::int32_t> id;  // 0 … count − 1 in order of generation

  void resize(int n) {
    count = n;
    for (auto* array : {&position, &velocity, &spin, &force, &torque, &listed_at})
      array->assign(n + 1, Quad{});
    position[n] = {1e9, 1e9, 1e9, 0.0};
    id.resize(n);
    for (int i = 0; i < n; ++i) id[i] = i;
  }
};

}  // namespace furrow::dem
