// Lets a new bed fall until it comes to rest.
//
// A bed is at rest if net forces are small compared with contact forces, whatever the number of grains and contacts, as
// in [Agnolin & Roux 2007, doi:10.1103/PhysRevE.76.061302, §II.C], who require small net forces and kinetic energy on
// the scales of the load:
//   Σ|net force| / Σ|contact force| < kSettledForceRatio,   |floor force − weight| / weight < kSettledFloorError,
//   E_kin < ½ m kRestSpeed²,   E_kin < kRestEnergy m g r,   m: all grains.
// The second bound on the kinetic energy is the stricter one for grains below 0.2 mm.
#pragma once

#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {

inline constexpr double kSettledForceRatio = 1e-3;
inline constexpr double kSettledFloorError = 1e-3;

struct SettleResult {
  bool settled = false;
  double force_ratio = 0.0;  // Σ|net force| / Σ|contact force|
  double floor_error = 0.0;  // |floor force − weight| / weight
  double time = 0.0;         // simulated, s
  double speed = 0.0;        // rms of the grains, m/s
  std::int64_t steps = 0;
};

/// Step for settling, s: a fixed share of the stable one, independent of the run's step.
double settle_step(const DemOptions& options);

/// Coefficients while the bed settles: side walls without friction, so that the floor carries the whole weight; the
/// impulse limit of law hertz_tanh is on.
SolverCoefficients settle_coefficients(const DemOptions& options);

inline constexpr double kMaxSettleTime = 4.0;  // s
inline constexpr double kFallDrag = 4.0;       // 1/s, while layers fall, unless settling_drag is given
inline constexpr double kJointDrag = 60.0;     // 1/s, if the grains lie except for gaps of a grain or two
inline constexpr double kRestDrag = 20.0;      // 1/s, once the grains lie; those on top must still roll into place
inline constexpr double kRestSpeed = 0.002;    // rms, m/s; slower grains count as at rest
inline constexpr double kRestEnergy = 1e-3;    // kinetic energy over m g r; grains with less count as at rest
inline constexpr int kSettleCheckEvery = 40;   // steps

/// Sets force ratio, floor error and speed from the solver's last step, which must have measured its sums.
void measure_rest(const GrainSolver& solver, SettleResult& result);

/// Runs the solver until the bed has settled with all grains awake, or `most` seconds have passed.
/// May throw what `progress` throws.
/// @param drag in the beginning; that of lying grains is at least kRestDrag
/// @throws Error(physics) when a grain is lost.
SettleResult settle(GrainSolver& solver, const DemOptions& options, const ProgressCall& progress,
                    double most = kMaxSettleTime, double drag = kFallDrag);

}  // namespace furrow::terrain::dem
