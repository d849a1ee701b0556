// Whether means over the averaging window may be quoted.
#pragma once

#include <string>
#include <vector>

#include "nodes/output/statistics.hpp"

namespace furrow::output {

/// What a steady mean is judged by, besides its statistics.
struct SteadyWindow {
  double load = 0.0;           // weight on the wheel, N
  double settlement = 0.0;     // what tire and ground give under it, m; 0: not known
  double bounce_period = 0.0;  // s; 0: not known
  double duration = 0.0;       // s
  double travel = 0.0;         // of the axle or of the tread, whichever is longer, m
  double radius = 0.0;         // undeformed tire radius, m
  bool whole_facets = false;   // the window holds a whole number of tire facets, within one line of the series
};

/// Period in which a loaded wheel bounces on its tire and soil, s: T = 2π √(m/k) = 2π √(z/(κ g)) with k = κ W/z. z is
/// what tire and soil give under the load W, sinkage and deflection together, m. κ = 1.9 is how much stiffer they are
/// about that state than W/z: the report's small rig without its touch-down damper bounces with 0.25 s (minima of
/// the axle's height at 0.166, 0.434 and 0.663 s) at z = 28 mm. A force that goes with depth^1.5, as of a Hertz contact
/// or of a wheel on soil with p ∝ z [Bekker 1956], gives 1.5; soil that unloads is stiffer. 0 where z is not positive.
double bounce_period(double settlement, double gravity);

/// Fewer independent samples make no steady mean. With 10 the standard error of a stationary series is a sixth too
/// small on average and the drift test finds a drift in 3.3 % of them instead of 2.5 %; with 6 it is a quarter too
/// small, for some half as large as it should be, and drifts are found in twice as many series as stated
/// (tests/studies/steadiness.csv).
inline constexpr double kLeastSamples = 10.0;

/// Why a mean over this window is not steady, in words; empty when it is: neither pull nor sinkage drifts, ten
/// independent samples or more, sem at most 2 % of the load, at least 3 bounce periods, 2 radii of travel, a whole
/// number of facets. A drift of less than 0.5 % of the load, or of 2 % of what tire and ground give, counts as none; a
/// pull that varies by less than 0.5 % of the load needs no ten samples.
/// Each drift is found in 2.5 % of the windows of a stationary run, one of the two in 5 % at most.
std::vector<std::string> unsteady_because(const SeriesStatistics& pull, const SeriesStatistics& sinkage,
                                          const SteadyWindow& window);

}  // namespace furrow::output
