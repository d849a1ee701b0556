// How fast this machine steps grains and tires: measured within a second or two, once for each machine and build of the
// program, and kept among the user's caches.
#pragma once

namespace furrow::scenario {

/// Processor time of one core, so that it holds on a busy machine too.
struct MachineSpeed {
  double grain_step = 0.0;   // of one grain in one step, law mindlin with cohesion, s
  double tire_step = 0.0;    // of the reference tire in one step, s
  int tire_coordinates = 0;  // of the reference tire
  int cores = 1;             // that this process may use
};

/// Takes rates that were kept where there are any, otherwise measures and keeps them. @throws Error when the program's
/// own data files are missing
MachineSpeed machine_speed();

}  // namespace furrow::scenario
