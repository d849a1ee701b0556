#include "nodes/output/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"

namespace furrow::output {
namespace {

constexpr double kWindow = 5.0;        // lags summed, in integrated autocorrelation times
constexpr double kSteadySem = 0.02;    // of the load: largest standard error of a steady pull
constexpr double kBounces = 3.0;       // the window must hold
constexpr double kSteadyTravel = 2.0;  // undeformed radii the window must hold
constexpr double kHardening = 1.9;     // κ of bounce_period

double mean_of(std::span<const double> x) {
  FURROW_ASSERT(!x.empty(), x.size());
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double integrated_autocorrelation_time(std::span<const double> x, double mean, double variance) {
  FURROW_ASSERT(!x.empty() && variance > 0.0, x.size(), variance);
  const std::size_t n = x.size();
  double tau = 1.0;
  std::size_t lag = 1;
  for (; lag < n / 2; ++lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += (x[i] - mean) * (x[i + lag] - mean);
    tau += 2.0 * sum / (static_cast<double>(n) * variance);
    if (static_cast<double>(lag) >= kWindow * tau) break;
  }
  return std::max(tau * (1.0 + static_cast<double>(2 * lag + 1) / static_cast<double>(n)), 1.0);
}

double slope(std::span<const double> x, double mean) {
  FURROW_ASSERT(!x.empty(), x.size());
  const double middle = 0.5 * static_cast<double>(x.size() - 1);
  double xy = 0.0, xx = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    xy += t * (x[i] - mean);
    xx += t * t;
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

}  // namespace

SeriesStatistics statistics(std::span<const double> x) {
  SeriesStatistics s;
  const std::size_t n = x.size();
  s.sem = std::numeric_limits<double>::infinity();
  s.mean = n > 0 ? mean_of(x) : std::numeric_limits<double>::quiet_NaN();
  if (n < 4) return s;
  double squares = 0.0;
  for (const double value : x) squares += (value - s.mean) * (value - s.mean);
  const double variance = squares / static_cast<double>(n);
  s.std = std::sqrt(squares / static_cast<double>(n - 1));
  s.n_eff = static_cast<double>(n);
  if (variance > 0.0) s.n_eff /= integrated_autocorrelation_time(x, s.mean, variance);
  s.sem = s.std / std::sqrt(s.n_eff);
  s.drift = slope(x, s.mean);
  const double apart = std::abs(mean_of(x.first(n / 2)) - mean_of(x.subspan(n / 2)));
  s.halves_agree = apart <= 2.0 * std::sqrt(2.0) * s.sem;
  return s;
}

double bounce_period(double settlement, double gravity) {
  FURROW_ASSERT(gravity > 0.0, gravity);
  if (!(settlement > 0.0)) return 0.0;
  return 2.0 * std::numbers::pi * std::sqrt(settlement / (kHardening * gravity));
}

std::vector<std::string> unsteady_because(const SeriesStatistics& pull, const SteadyWindow& window) {
  FURROW_ASSERT(window.radius >= 0.0, window.radius);
  std::vector<std::string> reasons;
  const auto require = [&reasons](bool ok, std::string reason) {
    if (!ok) reasons.push_back(std::move(reason));
  };
  require(pull.halves_agree, "the halves of the averaging window differ by more than 2√2 standard errors");
  require(
      pull.sem <= kSteadySem * window.load,
      fmt::format("the standard error {:.3g} N is above {:.0f} % of the load", pull.sem, 100.0 * kSteadySem));
  require(window.duration >= kBounces * window.bounce_period,
          fmt::format("the window of {:.3g} s is shorter than {:.0f} bounce periods ({:.3g} s)",
                      window.duration, kBounces, kBounces * window.bounce_period));
  require(window.travel >= kSteadyTravel * window.radius,
          fmt::format("the window holds {:.3g} m of rolling, less than {:.0f} tire radii", window.travel,
                      kSteadyTravel));
  require(window.whole_facets, "the window does not hold a whole number of tire facets");
  return reasons;
}

}  // namespace furrow::output
