// Whether means over the averaging window are steady.
#pragma once

#include <string>
#include <vector>

#include "nodes/output/statistics.hpp"

namespace furrow::output {

/// Criteria for a steady mean besides its statistics.
struct SteadyWindow {
  double load = 0.0;           // weight on the wheel, N
  double settlement = 0.0;     // of the wheel on tire and ground, m; 0: not known
  double bounce_period = 0.0;  // s; 0: not known
  double duration = 0.0;       // s
  double travel = 0.0;         // of the axle or of the tread, whichever is longer, m
  double radius = 0.0;         // undeformed tire radius, m
  bool whole_facets = false;   // the window covers a whole number of tire facets, within one line of the series
};

/// Period in which a loaded wheel bounces on its tire and soil, s: T = 2π √(m/k) = 2π √(z/(κ g)) with k = κ W/z. z is
/// the sum of sinkage and deflection under the load W, m. κ = 1.9 is the ratio of the stiffness about that state to
/// W/z: the report's small rig without its touch-down damper bounces with 0.25 s (minima of the axle's height at 0.166,
/// 0.434 and 0.663 s) at z = 28 mm. A force that grows with depth^1.5, as in a Hertz contact or for a wheel on soil
/// with p ∝ z [Bekker 1956], gives 1.5; unloading soil is stiffer. 0 if z is not positive.
double bounce_period(double settlement, double gravity);

/// Least number of independent samples for a steady mean. With 10, the standard error of a stationary series is a sixth
/// too small on average, and the drift test finds a drift in 3.3 % of them instead of 2.5 %. With 6 it is a quarter too
/// small, for some series half as large as it should be, and drifts are found in twice as many series as stated
/// (tests/studies/steadiness.csv).
inline constexpr double kLeastSamples = 10.0;

/// Returns the reasons why a mean over this window is not steady; empty if it is. A steady mean needs: no drift of pull
/// or sinkage, ten independent samples, sem at most 2 % of the load, 3 bounce periods, 2 radii of travel, and a whole
/// number of facets. A drift of less than 0.5 % of the load, or 2 % of the settlement, does not count. A pull that
/// varies by less than 0.5 % of the load does not need ten samples. Each drift is found in 2.5 % of the windows of a
/// stationary run, one of the two in 5 % at most.
std::vector<std::string> unsteady_because(const SeriesStatistics& pull, const SeriesStatistics& sinkage,
                                          const SteadyWindow& window);

}  // namespace furrow::output
