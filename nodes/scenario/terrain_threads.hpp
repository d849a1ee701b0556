// How many OpenMP threads the terrain takes where the scenario leaves it open. Results do not depend on it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "protocol/core/assert.hpp"

namespace furrow::scenario {

/// Most threads that the terrain takes by default: a barrier over more costs more than they save.
inline constexpr int kMaxAutoThreads = 32;

/// From so many grains on the terrain takes the cores of the other ranks too: its steps are long then against the time
/// that a barrier waits for a thread whose core a tire has. Six ranks on two cores, two threads against one: 1.4 times
/// as fast with 1,140,000 grains, 1.3 times slower with 67,000.
inline constexpr std::int64_t kManyGrains = 500'000;

/// The cores that the others leave, for each rank of the terrain; all where these are fewer than half and the grains
/// are many.
/// @param others  ranks of this machine that need a core of their own
/// @param grains  of all ranks; 0: not known
inline int auto_terrain_threads(int cores, int others, int terrain_ranks, std::int64_t grains) {
  FURROW_ASSERT(cores > 0 && others >= 0 && terrain_ranks > 0 && grains >= 0, cores, others, terrain_ranks, grains);
  const int left = cores - others;
  const bool share = grains >= kManyGrains && 2 * left < cores;
  return std::clamp((share ? cores : left) / terrain_ranks, 1, kMaxAutoThreads);
}

}  // namespace furrow::scenario
