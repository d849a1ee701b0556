// Estimates, before any grain exists, how hard wheels press grains together. Large loads make the terrain refine its
// steps, and may end a run (terrain/dem/refinement/).
//
// A wheel's mean pressure p (wheel_scales.hpp) puts f̄ ≈ p d² on a grain of diameter d. Forces between grains are
// distributed about exponentially [Radjai et al. 1996, doi:10.1103/PhysRevLett.77.274]. Of the n grains in the contacts
// of all wheels, the number pressed by more than x f̄ at an instant is
//   λ(x) = A Σ n e^{−x},   x(δ) = (K δ^{3/2} − F_c)/(p d²), the smaller one of grain–grain and grain–tire,
// and 1 − e^{−λ} is the share of the time in which a contact is deeper than δ. A includes the grains below the contact,
// and the 100 calm steps before the terrain takes larger parts again.
//
// A = 0.6 and the largest force of a run, kLargest = 8 f̄, compared with runs at x_δ, where one part per step stops
// being stable, and x_30, where overlaps are 30 % of the diameter (E in MPa):
//
//   run                                          n    x_δ    refined here, in the run   x_30   in the run
//   hmmwv_straight, E 24.9, step 1e-4          220    1.8    1.00, 0.92 until it failed  7.4    failed after 1.6 s
//   hmmwv_straight, E 100, step 5e-5           220    5.5    0.41, 0.76                 19.5    largest seen 0.09 d
//   rover_small                                 53    3.6    0.59, 0.19                 13.3    largest seen 0.13 d
//   hmmwv_small                                 95    4.7    0.42, 0.24                  9.0    largest seen 0.22 d
//   small rig on LETE sand, E 100               82    4.5    0.44, 0.94
//   small rig on the report's soil, r 15 mm     33   10.1    0, 0                        9.3
//   small rig on the report's soil              74   none    0, 0                        9.3    largest seen 0.21 d
//   small rig on the report's soil, E 6.2       74   none    0, 0                        2.0    failed after 0.2 s
//
// So the share is right within a factor of three. It also grows with the speed of the treads; this is neglected,
// because a vehicle's driver sets that speed. In hmmwv_straight 0.97 of the steps were refined at 7 m/s.
#pragma once

#include <optional>

#include "nodes/scenario/scenario.hpp"
#include "nodes/scenario/wheel_scales.hpp"

namespace furrow::scenario {

struct GrainLoads {
  double overlap = 0.0;   // the largest in a run of some seconds, of a mean grain's diameter, -
  bool on_tire = false;   // between a grain and a tire, not two grains
  std::size_t wheel = 0;  // under which it occurs
  double refined = 0.0;   // share of the time in which the terrain's steps are divided into parts, -
  double parts = 1.0;     // of one of its steps, on average
};

/// Without grains, or if an unstable step is allowed: no overlap, whole steps.
GrainLoads grain_loads(const Scenario& scenario);

/// The key that changes a largest overlap which would end the run, with the figure; none if the overlap is smaller.
std::optional<Bound> too_hard(const Scenario& scenario, const GrainLoads& loads);

}  // namespace furrow::scenario
