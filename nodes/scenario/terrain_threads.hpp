// Number of OpenMP threads of the terrain if the scenario leaves it open. Results do not depend on it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "protocol/core/assert.hpp"
#include "terrain/dem/dem_terrain.hpp"

namespace furrow::scenario {

/// Most threads that the terrain uses by default: a barrier over more threads costs more than they save.
inline constexpr int kMaxAutoThreads = 32;

/// From this number of grains on, the terrain also uses the cores of the other ranks. Its steps are then long compared
/// with the time that a barrier waits for a thread whose core a tire uses. Six ranks on two cores, two threads compared
/// with one: 1.4 times as fast with 1,140,000 grains, 1.3 times slower with 67,000.
inline constexpr std::int64_t kManyGrains = 500'000;

/// Returns the cores that the others leave, for each rank of the terrain; all cores if fewer than half are left and
/// there are many grains.
/// @param others  ranks of this machine that need a core of their own
/// @param grains  of all ranks; 0: not known
inline int auto_terrain_threads(int cores, int others, int terrain_ranks, std::int64_t grains) {
  FURROW_ASSERT(cores > 0 && others >= 0 && terrain_ranks > 0 && grains >= 0, cores, others, terrain_ranks, grains);
  const int left = cores - others;
  const bool share = grains >= kManyGrains && 2 * left < cores;
  return std::clamp((share ? cores : left) / terrain_ranks, 1, kMaxAutoThreads);
}

/// Threads that one rank of `grains` may also try, where the others leave it at most half of the cores: whether it is
/// faster on their cores too depends on how long they compute. 0: none.
/// @param chosen  what auto_terrain_threads() returns
inline int other_terrain_threads(int cores, int others, std::int64_t grains, int chosen) {
  FURROW_ASSERT(cores > 0 && others >= 0 && grains >= 0 && chosen > 0, cores, others, grains, chosen);
  const int left = std::max(1, cores - others);
  const int all = terrain::useful_threads(std::min(cores, kMaxAutoThreads), static_cast<double>(grains));
  return 2 * left > cores || all <= left ? 0 : chosen == left ? all : left;
}

}  // namespace furrow::scenario
