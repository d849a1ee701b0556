// Duration of a run on this machine, if nobody else uses it.
//
// A step takes as long as its slowest node, and at least the processor time of the step divided by the cores:
//   T = max(max tires, terrain/threads, (Σ tires + terrain + messages)/cores) + latency.
// Writing is added: each frame and checkpoint takes as long as its files, which the ranks write at the same time. The
// terrain's time counts the grains awake: those near an axle if parcels may sleep. A terrain with a core for each rank
// takes the time of one of them (terrain/liggghts/rank_cost.hpp). If contacts are expected to be too hard for its step,
// the step is divided into parts (grain_loads.hpp).
#pragma once

#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct RunTime {
  bool bed_is_kept = false;  // in the cache, or the user's file: nothing needs to settle
  double bed = 0.0;          // preparing it, s
  double start = 0.0;        // until all ranks have begun, s
  double run = 0.0;          // all communication steps, s
  double writing = 0.0;      // frames and checkpoints, s
  double step = 0.0;         // one communication step, s
  double tire = 0.0;         // the slowest tire in it, s
  double terrain = 0.0;      // a rank of the terrain on its threads in it, s
  double awake = 1.0;        // mean share of grains that are stepped
  double refined = 0.0;      // share of the time in which the terrain's steps are divided into parts
  double ghosts = 0.0;       // copies of neighbours' grains that a rank of the terrain also steps
  int ranks = 1;             // of the terrain
  int threads = 1;           // of each of them
  int cores = 1;

  double all() const { return start + bed + run + writing; }
};

RunTime run_time(const Scenario& scenario, const MachineSpeed& machine);

}  // namespace furrow::scenario
