// Speed of this machine for grains and tires: measured within a second or two, once for each machine and build of the
// program, and kept in the user's cache.
#pragma once

namespace furrow::scenario {

/// Processor time of one core, so that it also holds on a busy machine.
struct MachineSpeed {
  double grain_step = 0.0;   // of one grain in one step, law mindlin with cohesion, s
  double tire_step = 0.0;    // of the reference tire in one step, s
  int tire_coordinates = 0;  // of the reference tire
  int cores = 1;             // that this process may use
};

/// Returns kept rates, or measures and keeps them. @throws Error if the program's own data files are missing
MachineSpeed machine_speed();

}  // namespace furrow::scenario
