#include "nodes/output/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "protocol/core/assert.hpp"
#include "protocol/core/student_t.hpp"

namespace furrow::output {
namespace {

constexpr double kWindow = 5.0;  // lags summed, in integrated autocorrelation times

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

/// C(j) of DriftTest.
double cosine_sum(std::span<const double> x, double mean, int j) {
  FURROW_ASSERT(!x.empty() && j > 0, x.size(), j);
  const auto n = static_cast<double>(x.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += (x[i] - mean) * std::cos(std::numbers::pi * j * (static_cast<double>(i) + 0.5) / n);
  return std::sqrt(2.0 / n) * sum;
}

DriftTest drift_test(std::span<const double> x, double mean) {
  FURROW_ASSERT(x.size() > 1, x.size());
  DriftTest test;
  const std::size_t half = x.size() / 2;
  test.change = mean_of(x.subspan(half)) - mean_of(x.first(half));
  if (x.size() < 2 * (kDriftCosines + 1)) return test;
  static const double limit = student_t(kDriftCosines, 0.5 * kDriftLevel);
  double squares = 0.0;
  for (int j = 2; j <= kDriftCosines + 1; ++j) squares += std::pow(cosine_sum(x, mean, j), 2);
  // C(1) is positive if the first half is above the second.
  const double first = -cosine_sum(x, mean, 1), others = std::sqrt(squares / kDriftCosines);
  if (first != 0.0) test.t = first / others;
  test.found = std::abs(test.t) > limit;
  return test;
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
  s.slope = slope(x, s.mean);
  s.drift = drift_test(x, s.mean);
  return s;
}

}  // namespace furrow::output
