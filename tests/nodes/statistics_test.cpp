// References: the first-order autoregressive process x(i) = φ x(i−1) + ε, whose integrated autocorrelation time is
// τ = (1 + φ)/(1 − φ) and whose variance is σ²/(1 − φ²) (Box & Jenkins, Time Series Analysis, chapter 3); batch means.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "nodes/output/statistics.hpp"
#include "tests/nodes/synthetic_series.hpp"

namespace furrow {
namespace {

std::vector<double> autoregressive(double phi, double mean, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<double> samples = testing::autoregressive(phi, count, engine);
  for (double& sample : samples) sample += mean;
  return samples;
}

TEST(Statistics, effective_number_of_samples_matches_the_autoregressive_closed_form) {
  for (const double phi : {0.0, 0.5, 0.9}) {
    const std::size_t n = 20000;
    const auto s = output::statistics(autoregressive(phi, 3.0, n, 11));
    const double expected = static_cast<double>(n) * (1.0 - phi) / (1.0 + phi);
    EXPECT_NEAR(s.n_eff / expected, 1.0, 0.15) << "phi = " << phi;
    EXPECT_NEAR(s.std * std::sqrt(1.0 - phi * phi), 1.0, 0.03) << "phi = " << phi;
  }
}

TEST(Statistics, the_true_mean_lies_within_two_standard_errors_nineteen_times_in_twenty) {
  const int trials = 400;
  int inside = 0;
  for (int i = 0; i < trials; ++i) {
    const auto s = output::statistics(autoregressive(0.9, 5.0, 900, 100 + i));
    inside += std::abs(s.mean - 5.0) <= 1.96 * s.sem;
  }
  // 95 % of 400, less the loss from a standard error estimated with about 47 independent samples
  EXPECT_GE(inside, 360);
  EXPECT_LE(inside, 396);
}

TEST(Statistics, standard_error_matches_means_of_batches_of_ten_autocorrelation_times) {
  const auto samples = autoregressive(0.8, 0.0, 18000, 5);  // tau = 9
  const std::size_t length = 90, batches = samples.size() / length;
  std::vector<double> means;
  for (std::size_t b = 0; b < batches; ++b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < length; ++i) sum += samples[b * length + i];
    means.push_back(sum / length);
  }
  const double by_batches = output::statistics(means).std / std::sqrt(static_cast<double>(batches));
  EXPECT_NEAR(output::statistics(samples).sem / by_batches, 1.0, 0.2);
}

TEST(Statistics, a_straight_line_has_its_slope_and_is_a_drift) {
  std::vector<double> line;
  for (int i = 0; i < 100; ++i) line.push_back(2.0 + 0.25 * i);
  const auto s = output::statistics(line);
  EXPECT_NEAR(s.slope, 0.25, 1e-12);
  EXPECT_NEAR(s.drift.change, 12.5, 1e-12);
  EXPECT_TRUE(s.drift.found);
  EXPECT_GT(s.drift.t, 0.0);
  EXPECT_NEAR(s.mean, 2.0 + 0.25 * 49.5, 1e-12);
}

TEST(Statistics, a_step_and_a_decay_are_drifts_whatever_they_do_to_the_standard_error) {
  std::mt19937_64 engine(8);
  std::vector<double> step = testing::autoregressive(0.9, 800, engine), decay = step;
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] += i < 400 ? 0.0 : 12.0;
    decay[i] += 20.0 * std::exp(-static_cast<double>(i) / 300.0);
  }
  EXPECT_GT(output::statistics(step).drift.t, 0.0);
  EXPECT_TRUE(output::statistics(step).drift.found);
  EXPECT_LT(output::statistics(decay).drift.t, 0.0);
  EXPECT_TRUE(output::statistics(decay).drift.found);
}

TEST(Statistics, a_constant_has_no_error_and_no_samples_have_no_mean) {
  const auto constant = output::statistics(std::vector<double>(50, 7.0));
  EXPECT_EQ(constant.mean, 7.0);
  EXPECT_EQ(constant.sem, 0.0);
  EXPECT_FALSE(constant.drift.found);
  EXPECT_TRUE(std::isnan(output::statistics({}).mean));
  EXPECT_TRUE(std::isinf(output::statistics(std::vector<double>(3, 1.0)).sem));
}

}  // namespace
}  // namespace furrow
