// Needs of a scenario's run, before any rank exists, and the resources of this machine.
#pragma once

#include <cstdint>

#include "nodes/scenario/scenario.hpp"

namespace furrow::scenario {

struct Estimate {
  terrain::TerrainEstimate terrain;
  std::int64_t steps = 0;         // communication steps
  std::int64_t coordinates = 0;   // of all tires
  double memory = 0.0;            // of all ranks, bytes
  double disk = 0.0;              // of the results, bytes
  double frames = 0.0;            // number written
  double frame_bytes = 0.0;       // of one of them, all ranks
  double checkpoints = 0.0;       // number written, without those by wall time
  double checkpoint_bytes = 0.0;  // of one of them
};

Estimate estimate(const Scenario& scenario);

/// 0: unknown.
struct MachineState {
  double memory_free = 0.0;  // bytes
  double disk_free = 0.0;    // in the working directory, bytes
};
MachineState machine_state();

}  // namespace furrow::scenario
