// Stationary series of known correlation, and statistics of many of them.
//
//   autoregressive  x(i) = φ x(i−1) + ε: τ = (1 + φ)/(1 − φ) (Box & Jenkins, Time Series Analysis, chapter 3)
//   moving average  x(i) = Σ ε over the last τ steps
//   bouncing x(i) = 2 a cos ω x(i−1) − a² x(i−2) + ε, a wheel on its tire: damped oscillations
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "nodes/output/statistics.hpp"

namespace furrow::testing {

using Series = std::vector<double>;

/// Stationary from its first sample on, like all these series.
inline Series autoregressive(double phi, std::size_t count, std::mt19937_64& engine) {
  std::normal_distribution<double> noise;
  double x = noise(engine) / std::sqrt(1.0 - phi * phi);
  Series samples(count);
  for (double& sample : samples) sample = x = phi * x + noise(engine);
  return samples;
}

inline Series moving_average(std::size_t length, std::size_t count, std::mt19937_64& engine) {
  std::normal_distribution<double> noise;
  Series kicks(count + length), samples(count);
  for (double& kick : kicks) kick = noise(engine);
  double sum = 0.0;
  for (std::size_t i = 0; i < length; ++i) sum += kicks[i];
  for (std::size_t i = 0; i < count; ++i) {
    sum += kicks[i + length] - kicks[i];
    samples[i] = sum;
  }
  return samples;
}

/// @param period in samples; damping: share of the critical one
inline Series bouncing(double period, double damping, std::size_t count, std::mt19937_64& engine) {
  std::normal_distribution<double> noise;
  const double a = std::exp(-2.0 * std::numbers::pi * damping / period);
  const double two_a_cos = 2.0 * a * std::cos(2.0 * std::numbers::pi / period);
  Series samples;
  double before = 0.0, x = 0.0;
  const auto transient = static_cast<std::size_t>(10.0 * period / damping);
  for (std::size_t i = 0; i < transient + count; ++i) {
    const double next = two_a_cos * x - a * a * before + noise(engine);
    before = x;
    x = next;
    if (i >= transient) samples.push_back(x);
  }
  return samples;
}

/// A kind of series with n_eff independent samples among n.
struct Process {
  const char* name;
  double n_eff;  // nominal; 0: no closed form
  std::function<Series(std::mt19937_64&)> make;
};

inline Process autoregressive_of(double n_eff, std::size_t n) {
  const double tau = static_cast<double>(n) / n_eff;
  return {"autoregressive", n_eff, [=](std::mt19937_64& e) { return autoregressive((tau - 1.0) / (tau + 1.0), n, e); }};
}
inline Process moving_average_of(double n_eff, std::size_t n) {
  const auto length = static_cast<std::size_t>(std::llround(static_cast<double>(n) / n_eff));
  return {"moving_average", n_eff, [=](std::mt19937_64& e) { return moving_average(length, n, e); }};
}

/// Shapes of a drift.
enum class Drift { line, step, decay };  // a decay falls to 1/e in a quarter of the window

/// Adds a drift whose halves differ by `change`.
inline void add_drift(Drift drift, double change, Series& samples) {
  const auto n = static_cast<double>(samples.size());
  const double of_decay = 0.25 * std::pow(1.0 - std::exp(-2.0), 2);  // half the difference of the halves' means
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double at = (static_cast<double>(i) + 0.5) / n;
    samples[i] += change * (drift == Drift::line   ? 2.0 * at
                            : drift == Drift::step ? (at < 0.5 ? 0.0 : 1.0)
                                                   : -std::exp(-4.0 * at) / (2.0 * of_decay));
  }
}

/// Statistics of many series of one kind.
struct Trials {
  double true_sem = 0.0;  // standard deviation of their means
  std::vector<output::SeriesStatistics> each;
};

inline Trials run_trials(const Process& process, int trials, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Trials result;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < trials; ++k) {
    result.each.push_back(output::statistics(process.make(engine)));
    sum += result.each.back().mean;
    squares += result.each.back().mean * result.each.back().mean;
  }
  result.true_sem = std::sqrt((squares - sum * sum / trials) / (trials - 1));
  return result;
}

/// The earlier test for drifts: halves within 2√2 standard errors of the whole window.
inline bool halves_apart(const output::SeriesStatistics& s) {
  return std::abs(s.drift.change) > 2.0 * std::sqrt(2.0) * s.sem;
}
inline bool drift_found(const output::SeriesStatistics& s) { return s.drift.found; }

/// Share of series in which a test finds an added drift. Its halves differ by `sigmas` times 2 · true_sem, the standard
/// deviation of the difference of the halves.
template <class Test>
double share_found(const Process& process, Drift drift, double true_sem, double sigmas, int trials, Test test) {
  std::mt19937_64 engine(2);
  int found = 0;
  for (int k = 0; k < trials; ++k) {
    Series samples = process.make(engine);
    add_drift(drift, sigmas * 2.0 * true_sem, samples);
    found += test(output::statistics(samples));
  }
  return static_cast<double>(found) / trials;
}

}  // namespace furrow::testing
