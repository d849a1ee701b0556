// Lets a new bed fall and come to rest.
#pragma once

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

/// "Settled" means Σ|net force|/Σ|contact force| below the first and |floor force − weight|/weight below the second.
inline constexpr double kSettledForceRatio = 1e-3;
inline constexpr double kSettledFloorError = 1e-3;

struct SettleResult {
  bool settled = false;
  double force_ratio = 0.0;  // Σ|net force| / Σ|contact force|
  double floor_error = 0.0;  // |floor force − weight| / weight
  double time = 0.0;         // simulated, s
  std::int64_t steps = 0;
};

/// Step used for settling, s: a fixed share of the stable one, independent of the run's step.
double settle_step(const DemOptions& options);

/// Coefficients while the bed settles: side walls without friction, so that the floor carries the whole weight; the
/// impulse limit of law hertz_tanh is on.
SolverCoefficients settle_coefficients(const DemOptions& options);

inline constexpr double kMaxSettleTime = 4.0;  // s
inline constexpr double kRestDrag =
    20.0;  // 1/s, once the grains lie; those on top must still roll to their places
inline constexpr double kRestSpeed = 0.002;   // rms, m/s: slower counts as at rest
inline constexpr int kSettleCheckEvery = 40;  // steps

/// Runs the solver until the bed is settled or `most` seconds have passed. May throw what `progress` throws.
/// @throws Error(physics) when a grain is lost.
SettleResult settle(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress,
                    double most = kMaxSettleTime);

}  // namespace furrow::terrain::dem
