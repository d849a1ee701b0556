#include "nodes/output/steadiness.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"

namespace furrow::output {
namespace {

constexpr double kSteadySem = 0.02;     // of the load: largest standard error of a steady pull
constexpr double kSmallPull = 0.005;    // of the load: a smaller change of the pull is ignored
constexpr double kSmallSinkage = 0.02;  // of the settlement: a smaller change of the sinkage is ignored
constexpr double kBounces = 3.0;        // least number in the window
constexpr double kSteadyTravel = 2.0;   // least travel in the window, in undeformed radii
constexpr double kHardening = 1.9;      // κ of bounce_period

bool drifts(const SeriesStatistics& series, double small) {
  return series.drift.found && std::abs(series.drift.change) > small;
}

}  // namespace

double bounce_period(double settlement, double gravity) {
  FURROW_ASSERT(gravity > 0.0, gravity);
  if (!(settlement > 0.0)) return 0.0;
  return 2.0 * std::numbers::pi * std::sqrt(settlement / (kHardening * gravity));
}

std::vector<std::string> unsteady_because(const SeriesStatistics& pull, const SeriesStatistics& sinkage,
                                          const SteadyWindow& window) {
  FURROW_ASSERT(window.radius >= 0.0, window.radius);
  std::vector<std::string> reasons;
  const auto require = [&reasons](bool ok, std::string reason) {
    if (!ok) reasons.push_back(std::move(reason));
  };
  require(!drifts(pull, kSmallPull * window.load),
          fmt::format("the pull drifts: by {:.3g} N from the first to the second half of the averaging window",
                      pull.drift.change));
  require(!drifts(sinkage, kSmallSinkage * window.settlement),
          fmt::format("the sinkage drifts: by {:.2g} mm from the first to the second half of the window",
                      1e3 * sinkage.drift.change));
  require(pull.n_eff >= kLeastSamples || pull.std <= kSmallPull * window.load,
          fmt::format("the window holds {:.2g} independent samples of the pull, fewer than {:.0f}", pull.n_eff,
                      kLeastSamples));
  require(pull.sem <= kSteadySem * window.load,
          std::isfinite(pull.sem)
              ? fmt::format("the standard error {:.3g} N is above {:.0f} % of the load", pull.sem, 100.0 * kSteadySem)
              : "the window holds too few lines of the series for a standard error");
  require(window.duration >= kBounces * window.bounce_period,
          fmt::format("the window of {:.3g} s is shorter than {:.0f} bounce periods ({:.3g} s)", window.duration,
                      kBounces, kBounces * window.bounce_period));
  require(
      window.travel >= kSteadyTravel * window.radius,
      fmt::format("the window holds {:.3g} m of rolling, less than {:.0f} tire radii", window.travel, kSteadyTravel));
  require(window.whole_facets, "the window does not hold a whole number of tire facets");
  return reasons;
}

}  // namespace furrow::output
