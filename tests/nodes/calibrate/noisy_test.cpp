// The optimizer for noisy models on functions with closed forms: true parameters are known, noise is drawn with a seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "nodes/calibrate/surrogate.hpp"
#include "protocol/core/error.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tests/refusal.hpp"

namespace furrow::calibrate {
namespace {

using namespace testing;
using Figures = std::function<std::vector<double>(std::span<const double>)>;

/// Normal deviates that depend on the parameters alone, as in a simulation with fixed seeds.
double deviate(std::span<const double> values, std::uint64_t seed, std::size_t figure) {
  std::uint64_t bits = seed * 0x9e3779b97f4a7c15u + figure;
  for (const double value : values)
    bits = (bits ^ std::hash<double>{}(value)) * 0xbf58476d1ce4e5b9u, bits ^= bits >> 31;
  std::mt19937_64 engine(bits);
  return std::normal_distribution<double>()(engine);
}

/// Figures with noise of a known size.
class NoisyModel final : public CalibrationModel {
 public:
  NoisyModel(Figures figures, std::vector<double> data, std::vector<double> sigma, std::vector<double> noise,
             std::uint64_t seed)
      : figures_(std::move(figures)), noise_(std::move(noise)), seed_(seed) {
    for (std::size_t k = 0; k < data.size(); ++k) {
      Target target;
      target.name = target.what = target.y_name = target.state = "figure" + std::to_string(k);
      target.x = {0.0}, target.y = {data[k]}, target.sigma = {sigma[k]}, target.labels = {target.name};
      targets_.fitted.push_back(std::move(target));
    }
  }
  std::vector<double> start_values() const override { return {}; }
  Prediction predict(std::span<const double> values, TargetSet, const ProgressCall& progress) override {
    asked.insert(std::vector<double>(values.begin(), values.end()));
    if (progress) progress("half of it", 0.5);
    Prediction found{figures_(values), noise_, "", 0.5};
    for (std::size_t k = 0; k < found.values.size(); ++k) {
      if (!std::isfinite(found.values[k])) return {{}, {}, "no answer here", 0.5};
      found.values[k] += noise_[k] * deviate(values, seed_, k);
    }
    return found;
  }
  nlohmann::ordered_json fitted_file(std::span<const double>, const std::string& source) const override {
    return {{"source", source}};
  }
  std::set<std::vector<double>> asked;

 private:
  Figures figures_;
  std::vector<double> noise_;
  std::uint64_t seed_;
};

Calibration noisy_study(Figures figures, std::vector<double> data, std::vector<double> sigma, std::vector<double> noise,
                        std::vector<Parameter> parameters, std::uint64_t seed, int evaluations) {
  static const CalibrationKind kind{"noisy", "nothing", {}, nullptr, optimize_noisy, true};
  Calibration c;
  c.file = "study.json", c.start = "start.json", c.name = "study", c.kind = &kind;
  c.parameters = std::move(parameters);
  c.starts = 4, c.seed = seed, c.evaluations = evaluations;
  c.model = std::make_unique<NoisyModel>(std::move(figures), std::move(data), std::move(sigma), std::move(noise), seed);
  c.result = "fitted.json", c.digest = "0123456789abcdef";
  return c;
}
const NoisyModel& model_of(const Calibration& c) { return dynamic_cast<const NoisyModel&>(*c.model); }

/// Three figures of two parameters, as φ, c and K of rolling friction and cohesion: bent, of very different size.
std::vector<double> soil_like(std::span<const double> p) {
  return {20.0 + 14.0 * (1.0 - std::exp(-2.0 * p[0])) + 0.05 * p[1], 80.0 * p[1] * (1.0 + 0.3 * p[0]),
          0.01 + 2e-4 * p[1] + 0.004 * p[0] * p[0]};
}
const std::vector<double> kSigma{0.5, 150.0, 1e-3}, kNoise{0.7, 250.0, 1e-3};
std::vector<Parameter> soil_parameters() {
  return {{"rolling", "-", 0.0, 1.0, 0.2, false}, {"cohesion", "kPa", 0.0, 60.0, 30.0, false}};
}

/// A study of these figures; `figures` may differ from the figures of the data.
Calibration soil_study(std::uint64_t seed, int evaluations, std::vector<double> data = {28.0, 1500.0, 0.014},
                       Figures figures = soil_like) {
  return noisy_study(std::move(figures), std::move(data), kSigma, kNoise, soil_parameters(), seed, evaluations);
}

TEST(Surrogate, gives_back_a_line_and_its_error) {
  // y = 3 − 2 s + ε: ordinary least squares has a closed form, and the process must add nothing to a line.
  const int n = 12;
  Eigen::MatrixXd places(1, n);
  Eigen::VectorXd values(n);
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise(0.0, 0.1);
  double mean = 0.0, square = 0.0, product = 0.0;
  for (int k = 0; k < n; ++k) {
    places(0, k) = k / 11.0;
    values[k] = 3.0 - 2.0 * places(0, k) + noise(engine);
    mean += values[k] / n;
  }
  for (int k = 0; k < n; ++k) {
    square += (places(0, k) - 0.5) * (places(0, k) - 0.5);
    product += (places(0, k) - 0.5) * (values[k] - mean);
  }
  const Surrogate surrogate(places, values, std::vector<double>(n, 0.1));
  const auto answer = surrogate.at(Eigen::VectorXd::Constant(1, 0.25));
  EXPECT_NEAR(answer.value, mean + product / square * -0.25, 0.02);
  EXPECT_NEAR(answer.gradient[0], product / square, 0.05);
  EXPECT_NEAR(std::sqrt(answer.variance), std::sqrt(surrogate.noise() * (1.0 / n + 0.0625 / square)), 0.02);
  EXPECT_GE(surrogate.noise(), 0.01);
}

TEST(Surrogate, an_evaluation_that_tells_a_large_error_hardly_counts) {
  const int n = 12;
  Eigen::MatrixXd places(1, n);
  Eigen::VectorXd values(n);
  std::vector<double> errors(n, 0.1);
  for (int k = 0; k < n; ++k) places(0, k) = k / 11.0, values[k] = 3.0 - 2.0 * places(0, k) + (k % 2 ? 0.1 : -0.1);
  const Eigen::VectorXd middle = Eigen::VectorXd::Constant(1, 0.5);
  const auto alone = Surrogate(places, values, errors).at(middle);
  values[4] = -40.0, errors[4] = 30.0;
  const auto told = Surrogate(places, values, errors).at(middle);
  EXPECT_NEAR(told.value, alone.value, 0.05);
  EXPECT_NEAR(std::sqrt(told.variance), std::sqrt(alone.variance), 0.05);
  EXPECT_GT(std::abs(Surrogate(places, values).at(middle).value - alone.value), 1.0);
}

TEST(OptimizeNoisy, what_the_surrogate_does_not_know_is_not_called_reached) {
  const Reach reach{3.0, 5.0, 5.0, 5.0, 0.0, 10.0};
  EXPECT_EQ(reach_state(reach, 3.3, 0.4), ReachState::not_known);
  EXPECT_EQ(reach_state(reach, 3.3, 4.0), ReachState::reached);
}

TEST(Surrogate, follows_a_bent_surface_and_its_gradient_is_that_of_its_value) {
  const int n = 30;
  Eigen::MatrixXd places(2, n);
  Eigen::VectorXd values(n);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto surface = [](double a, double b) { return 1e5 * (std::sin(2.0 * a) + a * b * b); };
  for (int k = 0; k < n; ++k) {
    places.col(k) << share(engine), share(engine);
    values[k] = surface(places(0, k), places(1, k));
  }
  const Surrogate surrogate(places, values);
  for (const double a : {0.2, 0.5, 0.8}) {
    const Eigen::Vector2d place(a, 0.4);
    const auto answer = surrogate.at(place);
    EXPECT_NEAR(answer.value, surface(a, 0.4), 300.0);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = 1e-5 * Eigen::Vector2d::Unit(k);
      EXPECT_NEAR(answer.gradient[k], (surrogate.at(place + step).value - surrogate.at(place - step).value) / 2e-5,
                  1.0);
    }
  }
}

TEST(OptimizeNoisy, true_parameters_lie_within_its_intervals_as_often_as_they_say) {
  const std::vector<double> truth{0.45, 18.0};
  const std::vector<double> exact = soil_like(truth);
  const int kTries = 40;
  int within = 0, reached = 0;
  double off = 0.0;
  for (int k = 0; k < kTries; ++k) {
    // The data have their own errors.
    std::vector<double> data = exact;
    for (std::size_t q = 0; q < data.size(); ++q)
      data[q] += kSigma[q] * deviate(truth, 1000 + static_cast<std::uint64_t>(k), q);
    const CalibrationResults results = calibrated(soil_study(static_cast<std::uint64_t>(k), 20, data));
    ASSERT_LE(results.optimum.evaluations, 20);
    for (std::size_t p = 0; p < 2; ++p) {
      const Estimate& e = results.confidence.estimates[p];
      if (e.low && *e.low <= truth[p] && truth[p] <= *e.high) ++within;
    }
    off += results.values[1] - truth[1];
    for (std::size_t q = 0; q < 3; ++q)
      reached += reach_state(results.optimum.reach[q], data[q], kSigma[q]) == ReachState::reached ? 1 : 0;
  }
  // 95 % of 80, less three standard deviations of a binomial count (1.9), and two for the choice of the surrogates'
  // lengths.
  RecordProperty("within", within);
  EXPECT_GE(within, 68);
  EXPECT_NEAR(off / kTries, 0.0, 1.0);  // kPa; one calibration scatters by 2 to 3
  EXPECT_GE(reached, 3 * kTries - 12);
}

TEST(OptimizeNoisy, the_same_study_gives_the_same_bits_and_keeps_to_its_budget) {
  for (const int evaluations : {least_evaluations(2), 14}) {
    const Calibration first = soil_study(5, evaluations), second = soil_study(5, evaluations);
    const CalibrationResults a = calibrated(first), b = calibrated(second);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(calibration_json(first, a).dump(), calibration_json(second, b).dump());
    EXPECT_LE(a.optimum.evaluations, evaluations);
    EXPECT_LE(model_of(first).asked.size(), static_cast<std::size_t>(evaluations));
    EXPECT_EQ(a.processor_time, 0.5 * static_cast<double>(model_of(first).asked.size()));
    // The optimum is one of the evaluated points.
    EXPECT_TRUE(model_of(first).asked.contains(a.values));
  }
}

TEST(OptimizeNoisy, an_interrupted_calibration_ends_with_the_same_bits) {
  const Calibration whole = soil_study(2, 16);
  const CalibrationResults expected = calibrated(whole);
  const furrow::testing::TemporaryFolder folder;
  int left = 5;
  const Calibration broken = soil_study(2, 16);
  EXPECT_THROW(calibrate(broken, folder.path(),
                         [&](const std::string&, double) {
                           if (--left == 0) throw Error(ExitCode::stopped, "stopped");
                         }),
               Error);
  const Calibration again = soil_study(2, 16);
  const CalibrationResults results = calibrate(again, folder.path(), {});
  EXPECT_LT(model_of(again).asked.size(), model_of(whole).asked.size());
  EXPECT_EQ(calibration_json(again, results).dump(), calibration_json(whole, expected).dump());
}

TEST(OptimizeNoisy, progress_goes_on_within_an_evaluation) {
  const Calibration c = soil_study(2, 16);
  const furrow::testing::TemporaryFolder folder;
  std::vector<double> shares;
  calibrate(c, folder.path(), [&](const std::string&, double share) { shares.push_back(share); });
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  ASSERT_GE(shares.size(), 2U);
  EXPECT_EQ(shares[0], 0.0);
  EXPECT_EQ(shares[1], 0.5 / 16.0);
}

TEST(OptimizeNoisy, a_target_that_cannot_be_reached_is_told_with_the_range) {
  // The largest first figure within the bounds is 20 + 14 (1 − e⁻²) + 3 = 35.1.
  const Calibration c = soil_study(1, 18, {45.0, 1500.0, 0.014});
  const CalibrationResults results = calibrated(c);
  EXPECT_EQ(reach_state(results.optimum.reach[0], 45.0, 0.5), ReachState::out_of_range);
  EXPECT_LT(results.optimum.reach[0].high, 38.0);
  std::string all;
  for (const std::string& warning : calibration_warnings(c, results)) all += warning + "\n";
  EXPECT_TRUE(holds(all, "figure0 of 45.00 ± 0.50 is not reached but"));
  EXPECT_TRUE(holds(all, "it is beyond all evaluations within these bounds"));
  EXPECT_EQ(calibration_json(c, results)["targets"][0]["figures"][0]["state"], "out of range");
}

TEST(OptimizeNoisy, what_the_figures_do_not_tell_apart_is_named) {
  // The figures depend only on the sum of the two parameters.
  const auto sum = [](std::span<const double> p) {
    return std::vector<double>{10.0 * (p[0] + p[1]), 5.0 * (p[0] + p[1])};
  };
  const std::vector<Parameter> parameters{{"a", "-", 0.0, 1.0, 0.4, false}, {"b", "-", 0.0, 1.0, 0.4, false}};
  const CalibrationResults results =
      calibrated(noisy_study(sum, {10.0, 5.0}, {0.2, 0.2}, {0.2, 0.2}, parameters, 1, 16));
  ASSERT_EQ(results.confidence.undetermined.size(), 1u);
  const std::vector<double>& direction = results.confidence.undetermined[0].direction;
  EXPECT_NEAR(std::abs(direction[0]), std::sqrt(0.5), 0.1);
  EXPECT_LT(direction[0] * direction[1], 0.0);
  EXPECT_GT(results.confidence.singular_values[0], 10.0 * results.confidence.singular_values[1]);
}

TEST(OptimizeNoisy, places_without_an_answer_are_left_out_and_too_few_answers_end_it) {
  const auto half = [](std::span<const double> p) { return p[0] > 0.8 ? std::vector<double>(3, NAN) : soil_like(p); };
  const CalibrationResults results = calibrated(soil_study(1, 18, soil_like(std::vector{0.4, 20.0}), half));
  EXPECT_NEAR(results.values[1], 20.0, 6.0);
  const auto none = [](std::span<const double>) { return std::vector<double>(3, NAN); };
  expect_refused(ExitCode::physics,
                 {"the model answers at 0 of the 7 places of the design, expected 4 or more; where it does not: no "
                  "answer here"},
                 [&] {
                   calibrated(soil_study(1, 18, {28.0, 1500.0, 0.014}, none));
                 });
}

}  // namespace
}  // namespace furrow::calibrate
