// References: the first-order autoregressive process x(i) = φ x(i−1) + ε, whose integrated autocorrelation time is
// τ = (1 + φ)/(1 − φ) and whose variance is σ²/(1 − φ²) (Box & Jenkins, Time Series Analysis, chapter 3); batch means.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "nodes/output/statistics.hpp"

namespace furrow {
namespace {

std::vector<double> autoregressive(double phi, double mean, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise;
  double x = noise(engine) / std::sqrt(1.0 - phi * phi);
  std::vector<double> samples(count);
  for (double& sample : samples) {
    x = phi * x + noise(engine);
    sample = mean + x;
  }
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
  // 95 % of 400, less what an estimated standard error of about 47 independent samples loses
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

TEST(Statistics, drift_is_the_slope_of_a_straight_line) {
  std::vector<double> line;
  for (int i = 0; i < 100; ++i) line.push_back(2.0 + 0.25 * i);
  const auto s = output::statistics(line);
  EXPECT_NEAR(s.drift, 0.25, 1e-12);
  EXPECT_NEAR(s.mean, 2.0 + 0.25 * 49.5, 1e-12);
}

TEST(Statistics, a_constant_has_no_error_and_no_samples_have_no_mean) {
  const auto constant = output::statistics(std::vector<double>(50, 7.0));
  EXPECT_EQ(constant.mean, 7.0);
  EXPECT_EQ(constant.sem, 0.0);
  EXPECT_TRUE(constant.halves_agree);
  EXPECT_TRUE(std::isnan(output::statistics({}).mean));
  EXPECT_TRUE(std::isinf(output::statistics(std::vector<double>(3, 1.0)).sem));
}

TEST(Steadiness, every_broken_condition_is_said_in_words) {
  output::SeriesStatistics pull;
  pull.sem = 50.0;
  pull.halves_agree = true;
  const output::SteadyWindow good{4609.0, 0.25, 0.9, 1.9, 0.4673, true};
  EXPECT_TRUE(output::unsteady_because(pull, good).empty());

  output::SteadyWindow bad = good;
  bad.duration = 0.7;
  EXPECT_EQ(output::unsteady_because(pull, bad).size(), 1u);
  bad.travel = 0.9;
  EXPECT_EQ(output::unsteady_because(pull, bad).size(), 2u);
  bad.whole_facets = false;
  EXPECT_EQ(output::unsteady_because(pull, bad).size(), 3u);
  pull.sem = 93.0;  // 2 % of the load is 92.18 N
  EXPECT_EQ(output::unsteady_because(pull, bad).size(), 4u);
  pull.halves_agree = false;
  EXPECT_EQ(output::unsteady_because(pull, bad).size(), 5u);
}

/// k = κ W/z and T = 2π √(m/k): the wheel of a laboratory bounces faster than that of a truck.
TEST(Steadiness, the_bounce_period_follows_from_what_tire_and_soil_give_under_the_load) {
  const double deep = output::bounce_period(0.028, 9.81), shallow = output::bounce_period(0.007, 9.81);
  EXPECT_NEAR(deep / shallow, 2.0, 1e-12);
  EXPECT_NEAR(deep, 0.25, 0.03);
  EXPECT_EQ(output::bounce_period(-0.01, 9.81), 0.0);
  EXPECT_EQ(output::bounce_period(std::nan(""), 9.81), 0.0);
  output::SeriesStatistics pull;
  pull.halves_agree = true;
  const output::SteadyWindow small{24.5, shallow, 0.5, 0.2, 0.058, true};
  EXPECT_TRUE(output::unsteady_because(pull, small).empty());
}

}  // namespace
}  // namespace furrow
