// Errors, intervals and identifiability of fits, against closed forms of linear least squares and by repetition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "protocol/core/error.hpp"
#include "protocol/core/student_t.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tests/refusal.hpp"

namespace furrow::calibrate {
namespace {

using namespace testing;

double line(double x, std::span<const double> p) { return p[0] + p[1] * x; }

// s² = Σr²/(n − 2), se(b) = s/√Sxx, se(a) = s √(1/n + x̄²/Sxx) [Draper & Smith 1998, Applied Regression Analysis,
// §1.4].
TEST(CalibrateStatistics, errors_of_a_line_match_the_closed_form) {
  const std::vector<double> x = steps(1.0, 9.0, 9), y{2.1, 3.9, 6.2, 7.8, 10.3, 11.7, 14.4, 15.6, 18.2};
  const CalibrationResults results = calibrated(
      study_of(line, x, y, {{"a", "-", -5.0, 5.0, 1.0, false}, {"b", "-", -10.0, 10.0, 0.0, false}}, 1, 0.3));
  const double n = 9.0;
  double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, off = 0.0;
  for (int k = 0; k < 9; ++k) mx += x[k] / n, my += y[k] / n;
  for (int k = 0; k < 9; ++k) xx += (x[k] - mx) * (x[k] - mx), xy += (x[k] - mx) * (y[k] - my);
  const double b = xy / xx, a = my - b * mx;
  for (int k = 0; k < 9; ++k) off += std::pow(y[k] - a - b * x[k], 2);
  const double s = std::sqrt(off / (n - 2.0)), error_b = s / std::sqrt(xx),
               error_a = s * std::sqrt(1.0 / n + mx * mx / xx);
  EXPECT_NEAR(results.values[0], a, 1e-8);
  EXPECT_NEAR(results.values[1], b, 1e-8);
  const std::vector<Estimate>& estimates = results.confidence.estimates;
  EXPECT_NEAR(estimates[0].standard_error.value(), error_a, 1e-6 * error_a);
  EXPECT_NEAR(estimates[1].standard_error.value(), error_b, 1e-6 * error_b);
  EXPECT_NEAR(estimates[1].high.value(), b + student_t(7.0) * error_b, 1e-6);
  EXPECT_NEAR(estimates[1].low.value(), b - student_t(7.0) * error_b, 1e-6);
  EXPECT_NEAR(results.confidence.deviation, s / 0.3, 1e-6);  // in units of σ
  EXPECT_EQ(results.confidence.freedom, 7);
  EXPECT_TRUE(results.confidence.undetermined.empty());
  EXPECT_NEAR(joint_r_squared({study_of(line, x, y, {}).model->targets(TargetSet::fitted)}, results.fitted.values),
              xy * xy / xx / (off + xy * xy / xx), 1e-9);  // 1 − SSE/SST, SST = SSE + Sxy²/Sxx
}

TEST(CalibrateStatistics, intervals_cover_the_truth_at_their_rate) {
  const auto decay = [](double x, std::span<const double> p) { return p[0] * std::exp(-x / p[1]); };
  const std::vector<double> truth{50.0, 0.8}, x = steps(0.1, 3.0, 15);
  std::mt19937_64 bits(11);
  std::normal_distribution<double> noise(0.0, 1.5);
  constexpr int kTimes = 600;
  int covered[2] = {0, 0};
  for (int n = 0; n < kTimes; ++n) {
    std::vector<double> y;
    for (const double at : x) y.push_back(decay(at, truth) + noise(bits));
    const CalibrationResults results = calibrated(
        study_of(decay, x, y, {{"height", "-", 1.0, 1e3, 10.0, true}, {"length", "m", 0.01, 10.0, 0.3, true}}));
    for (int k = 0; k < 2; ++k) {
      const Estimate& e = results.confidence.estimates[k];
      covered[k] += e.low.value() <= truth[k] && truth[k] <= e.high.value();
    }
  }
  // 95 %; three standard deviations of that rate over 600 draws are 2.7 %.
  for (const int count : covered) EXPECT_NEAR(count / static_cast<double>(kTimes), 0.95, 0.03);
}

TEST(CalibrateStatistics, a_combination_that_data_do_not_determine_is_named) {
  // Only the product a b and c can be identified.
  const auto product = [](double x, std::span<const double> p) { return p[0] * p[1] * x + p[2]; };
  std::vector<double> y;
  const std::vector<double> x = steps(0.0, 5.0, 12);
  std::mt19937_64 bits(3);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (const double at : x) y.push_back(6.0 * at + 4.0 + noise(bits));
  const std::vector<Parameter> parameters{
      {"a", "-", 0.1, 10.0, 1.0, true}, {"b", "-", 0.1, 10.0, 1.0, true}, {"c", "-", 0.0, 10.0, 1.0, false}};
  const Calibration study = study_of(product, x, y, parameters, 3);
  const CalibrationResults results = calibrated(study);
  ASSERT_EQ(results.confidence.undetermined.size(), 1u);
  const Undetermined& u = results.confidence.undetermined.front();
  EXPECT_NEAR(std::abs(u.direction[0]), std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(u.direction[0], -u.direction[1], 1e-3);
  EXPECT_NEAR(u.direction[2], 0.0, 1e-3);
  EXPECT_FALSE(results.confidence.estimates[0].standard_error);
  EXPECT_FALSE(results.confidence.estimates[1].standard_error);
  EXPECT_TRUE(results.confidence.estimates[2].standard_error);
  EXPECT_NEAR(results.values[0] * results.values[1], 6.0, 0.1);
  EXPECT_NEAR(results.values[2], 4.0, 0.2);
  const std::vector<std::string> warnings = calibration_warnings(study, results);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(holds(warnings[0], "the data do not determine 0.71 "));
  EXPECT_TRUE(holds(warnings[0], " − 0.71 "));
}

TEST(CalibrateStatistics, a_parameter_at_its_bound_is_held_and_the_others_are_the_least_there) {
  const std::vector<double> x = steps(1.0, 9.0, 9), y{2.1, 3.9, 6.2, 7.8, 10.3, 11.7, 14.4, 15.6, 18.2};
  const Calibration study =
      study_of(line, x, y, {{"a", "-", 1.0, 5.0, 2.0, false}, {"b", "-", -10.0, 10.0, 0.0, false}}, 2);
  const CalibrationResults results = calibrated(study);
  EXPECT_EQ(results.confidence.estimates[0].at, Bound::lower);
  EXPECT_EQ(results.values[0], 1.0);
  EXPECT_FALSE(results.confidence.estimates[0].standard_error);
  // b = Σ x (y − 1)/Σ x², se = √(Σr²/8/Σx²)
  double xy = 0.0, xx = 0.0, off = 0.0;
  for (int k = 0; k < 9; ++k) xy += x[k] * (y[k] - 1.0), xx += x[k] * x[k];
  for (int k = 0; k < 9; ++k) off += std::pow(y[k] - 1.0 - xy / xx * x[k], 2);
  EXPECT_NEAR(results.values[1], xy / xx, 1e-8);
  EXPECT_NEAR(results.confidence.estimates[1].standard_error.value(), std::sqrt(off / 8.0 / xx), 1e-7);
  ASSERT_EQ(calibration_warnings(study, results).size(), 1u);
  EXPECT_TRUE(holds(calibration_warnings(study, results)[0], "a ends at its lower bound of 1.00"));
}

TEST(CalibrateStatistics, data_that_the_model_does_not_describe_are_named) {
  const auto warned = [](std::vector<double> y) {
    const Calibration study = study_of([](double x, std::span<const double> p) { return p[0] * x; }, steps(1.0, 4.0, 4),
                                       std::move(y), {{"a", "N", 1e-3, 1e6, 1.0, true}});
    return calibration_warnings(study, calibrated(study));
  };
  const std::vector<std::string> falls = warned({9.0, 5.0, 4.0, 1.0});
  ASSERT_EQ(falls.size(), 1u);
  EXPECT_TRUE(holds(falls[0], "the fitted model does not describe curve (R² -"));
  EXPECT_TRUE(warned({1.1, 1.9, 3.1, 3.9}).empty());
}

TEST(CalibrateStatistics, what_is_done_never_falls_back_from_start_to_start) {
  // The optimum lies at a bound: each start has several rounds.
  const Calibration study = study_of([](double x, std::span<const double> p) { return p[0] * x * x + p[1] * x; },
                                     steps(0.0, 4.0, 9), {0.0, 1.4, 3.1, 4.4, 6.1, 7.4, 9.1, 10.4, 12.0},
                                     {{"a", "N", 0.1, 10.0, 5.0, true}, {"b", "N", 1.0, 100.0, 50.0, true}}, 4);
  std::vector<double> shares;
  const furrow::testing::TemporaryFolder folder;
  calibrate(study, folder.path(), [&](const std::string&, double share) { shares.push_back(share); });
  ASSERT_GT(shares.size(), 8u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.back(), 0.75);
  EXPECT_LE(shares.back(), 1.0);
}

TEST(CalibrateStatistics, starts_find_the_lower_of_two_leasts) {
  // Two minima in p: near 1 and, lower, near 8.
  const auto wells = [](double x, std::span<const double> p) {
    return x < 0.5 ? std::min(std::abs(p[0] - 1.0) + 0.5, std::abs(p[0] - 8.0)) : 0.1 * p[0];
  };
  const std::vector<Parameter> parameters{{"p", "-", 0.0, 10.0, 0.8, false}};
  const CalibrationResults one = calibrated(study_of(wells, {0.0, 1.0}, {0.0, 0.45}, parameters, 1));
  const CalibrationResults many = calibrated(study_of(wells, {0.0, 1.0}, {0.0, 0.45}, parameters, 12));
  EXPECT_LT(one.values[0], 2.0);
  EXPECT_NEAR(many.values[0], 8.0, 0.1);
  EXPECT_EQ(many.optimum.starts.size(), 12u);
}

TEST(CalibrateStatistics, a_model_without_answers_is_an_error_and_holes_are_stepped_around) {
  const auto nowhere = [](double, std::span<const double>) { return NAN; };
  const std::vector<Parameter> parameters{{"p", "-", 0.0, 10.0, 5.0, false}};
  expect_refused(ExitCode::physics, {"no answer here"}, [&] {
    calibrated(study_of(nowhere, {0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, parameters, 2));
  });
  const auto hole = [](double x, std::span<const double> p) { return p[0] > 6.0 ? NAN : p[0] * x; };
  const CalibrationResults results = calibrated(study_of(hole, {0.0, 1.0, 2.0}, {0.0, 4.1, 7.9}, parameters, 4));
  EXPECT_NEAR(results.values[0], 3.98, 1e-6);
}

}  // namespace
}  // namespace furrow::calibrate
