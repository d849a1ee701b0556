// How long a run will take on this machine, if nobody else uses it.
//
// A step takes as long as its slowest node, and not less than all processor time of the step over the cores:
//   T = max(max tires, terrain/threads, (Σ tires + terrain + messages)/cores) + latency.
// Meanwhile nobody writes: each frame and checkpoint takes as long as its files, which the ranks write side by side.
// The terrain's is that of the grains awake: those within kAwake tire radii of an axle, where strips may sleep. A
// terrain with a core for each rank takes the time of one of them (terrain/liggghts/rank_cost.hpp). Where
// contacts are expected to be too hard for its step it is taken in parts (grain_loads.hpp).
#pragma once

#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct RunTime {
  bool bed_is_kept = false;  // in the cache, or the user's file: nothing is settled
  double bed = 0.0;          // preparing it, s
  double start = 0.0;        // until all ranks have begun, s
  double run = 0.0;          // all communication steps, s
  double writing = 0.0;      // frames and checkpoints, s
  double step = 0.0;         // one of them, s
  double tire = 0.0;         // of it: the slowest tire, s
  double terrain = 0.0;      // of it: a rank of the terrain on its threads, s
  double awake = 1.0;        // mean share of the grains that is stepped
  double refined = 0.0;      // share of the time in which the terrain's steps are taken in parts
  double ghosts = 0.0;       // copies of its neighbours' grains that a rank of the terrain steps beside its own
  int ranks = 1;             // of the terrain
  int threads = 1;           // of each of them
  int cores = 1;

  double all() const { return start + bed + run + writing; }
};

RunTime run_time(const Scenario& scenario, const MachineSpeed& machine);

}  // namespace furrow::scenario
