// Measures how fast this machine steps grains: every grain is integrated and every contact evaluated in every step.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/core/progress_call.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

struct GrainBench {
  /// Law, material and precision; step and threads of the run.
  DemOptions grains;
  std::string bed = "default";  // CSV of positions (x_m,y_m,z_m), or default: the reference bed, from the cache
  int steps = 1000;
  int warm = 100;       // untimed steps before
  double settle = 0.0;  // time for which the bed first settles, at most, s
  std::string save;     // CSV that receives the positions before the timed steps; empty: none
};

/// Sums and forces are from the last step.
struct GrainBenchResult {
  double wall = 0.0;   // of the timed steps, s
  std::string device;  // cpu, or the name of the GPU
  int driver = 0;      // version of CUDA that its driver supports; 0: no GPU
  int grains = 0;
  std::int64_t contacts = 0, pairs_listed = 0;
  double floor_force = 0.0, weight = 0.0;  // N
  double kinetic_energy = 0.0;             // J
  double force_residual = 0.0;             // Σ|net force| / Σ|contact force|
  double settled = 0.0;                    // simulated time of settling, s
  double list_rebuilds = 0.0;              // in the timed steps, weighted by the share of grains in each
  double bytes = 0.0;                      // of the solver
  std::string state_hash;                  // of positions, velocities and spins
};

/// `progress` may throw. @throws Error
GrainBenchResult run_grain_bench(const GrainBench& bench, const ProgressCall& progress);

}  // namespace furrow::terrain::dem
