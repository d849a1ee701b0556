// The kinds `ring` and `planar`: known parameters are found again from curves that another program of the same physics
// made.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "protocol/files/data_files.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tire/press/press.hpp"
#include "tire/ring/ring_spec.hpp"

namespace furrow::calibrate::calibrate_ring_test {
namespace {

using namespace testing;

/// The flexible ring on a plate from its energy alone (tire/ring/ring_mechanics.hpp, (1) to (4)), with dense matrices,
/// a penalty instead of contact, and hoop tension from the length and the area of the polygon of segments. From
/// tire/ring it uses only the numbers of the file.
class DenseRing {
 public:
  explicit DenseRing(const tire::RingParams& p) : p_(p), n_(p.segments), phi_(2.0 * std::numbers::pi / n_) {
    Eigen::MatrixXd first = Eigen::MatrixXd::Zero(n_, n_), second = first;
    for (int j = 0; j < n_; ++j) {
      const int after = (j + 1) % n_, before = (j + n_ - 1) % n_;
      first(j, after) += 0.5 / std::sin(phi_), first(j, before) -= 0.5 / std::sin(phi_);
      const double c = 0.5 / (1.0 - std::cos(phi_));
      second(j, after) += c, second(j, before) += c, second(j, j) -= 2.0 * c;
    }
    Eigen::MatrixXd bend(n_, 2 * n_), shear(n_, 2 * n_);
    bend << -second, first;
    shear << first, second;
    belt_ = phi_ * (p.bending * bend.transpose() * bend + p.shear * shear.transpose() * shear);
    q_ = Eigen::VectorXd::Zero(2 * n_);
    while (true) {  // k₁q + k₂q² + k₃q³ = p R T by bisection
      draw_ = 0.5 * (low_ + high_);
      if (!(low_ < draw_ && draw_ < high_)) break;
      (wall(draw_) < (1.0 - p.tension_share) * p.pressure * p.radius * p.width ? low_ : high_) = draw_;
    }
    // The tension's tangent about the circle, ∫ (u'² − u²): sufficient for Newton's method.
    const double strength = phi_ * p.tension_share * p.pressure * p.width, g = 0.5 / (1.0 - std::cos(phi_));
    taut_ = Eigen::MatrixXd::Zero(2 * n_, 2 * n_);
    for (int j = 0; j < n_; ++j) {
      taut_(j, j) += strength * (2.0 * g - 1.0);
      taut_(j, (j + 1) % n_) -= strength * g, taut_((j + 1) % n_, j) -= strength * g;
    }
  }

  /// Upward force at a deflection, N.
  double press(double deflection) {
    for (int n = 0; n < 200; ++n) {
      Eigen::MatrixXd H = belt_ + taut_;
      Eigen::VectorXd g = belt_ * q_;
      add_tension(g);
      const double share = p_.radius * phi_ * p_.width,
                   rest = p_.air_share * std::numbers::pi * p_.radius * p_.radius * p_.width,
                   volume = rest + share * q_.head(n_).sum(), absolute = p_.pressure + p_.ambient;
      force_ = 0.0;
      for (int j = 0; j < n_; ++j) {
        const double w = q_[j] + draw_, angle = j * phi_;
        g[j] += phi_ * (wall(w) + p_.tension_share * p_.pressure * p_.radius * p_.width) +
                share * (p_.ambient - absolute * rest / volume);
        H(j, j) += phi_ * (p_.sidewall_1 + 2.0 * p_.sidewall_2 * w + 3.0 * p_.sidewall_3 * w * w);
        g[n_ + j] += phi_ * p_.tangential * q_[n_ + j];
        H(n_ + j, n_ + j) += phi_ * p_.tangential;
        const double gap =
            p_.radius - deflection - (p_.radius + q_[j]) * std::cos(angle) + q_[n_ + j] * std::sin(angle);
        if (gap >= 0.0 || std::cos(angle) < 0.5) continue;
        const Eigen::Vector2d slope(-std::cos(angle), std::sin(angle));
        g[j] += kPenalty * gap * slope[0], g[n_ + j] += kPenalty * gap * slope[1];
        force_ -= kPenalty * gap;
        H(j, j) += kPenalty * slope[0] * slope[0], H(n_ + j, n_ + j) += kPenalty * slope[1] * slope[1];
        H(j, n_ + j) += kPenalty * slope[0] * slope[1], H(n_ + j, j) += kPenalty * slope[0] * slope[1];
      }
      H.topLeftCorner(n_, n_).array() += share * share * absolute * rest / (volume * volume);
      const Eigen::VectorXd step = H.ldlt().solve(-g);
      q_ += step;
      if (step.cwiseAbs().maxCoeff() < 1e-12) break;
    }
    return force_;
  }

 private:
  static constexpr double kPenalty = 1e9;  // N/m
  Eigen::Vector2d place(int j) const {
    const double angle = (j % n_) * phi_, s = std::sin(angle), c = std::cos(angle);
    return {(p_.radius + q_[j % n_]) * s + q_[n_ + j % n_] * c, q_[n_ + j % n_] * s - (p_.radius + q_[j % n_]) * c};
  }
  /// σ p T (R cos(φ/2) ∂L − ∂A).
  void add_tension(Eigen::VectorXd& g) const {
    const double strength = p_.tension_share * p_.pressure * p_.width;
    for (int j = 0; j < n_; ++j) {
      const Eigen::Vector2d before = place(j + n_ - 1), here = place(j), after = place(j + 1), wide = after - before;
      const Eigen::Vector2d pull = (here - before).normalized() + (here - after).normalized();
      const Eigen::Vector2d force =
          strength * (p_.radius * std::cos(0.5 * phi_) * pull - 0.5 * Eigen::Vector2d(wide[1], -wide[0]));
      const double s = std::sin(j * phi_), c = std::cos(j * phi_);
      g[j] += force[0] * s - force[1] * c, g[n_ + j] += force[0] * c + force[1] * s;
    }
  }
  double wall(double w) const { return w * (p_.sidewall_1 + w * (p_.sidewall_2 + w * p_.sidewall_3)); }

  tire::RingParams p_;
  int n_;
  double phi_, low_ = 0.0, high_ = 0.2, draw_ = 0.0, force_ = 0.0;
  Eigen::MatrixXd belt_, taut_;
  Eigen::VectorXd q_;
};

class CalibrateRing : public StudyTest {
 protected:
  void SetUp() override {
    file_ = nlohmann::json::parse(std::ifstream(data_folder() / "tire" / "data" / "hmmwv_ring.json"));
    file_["segments"] = 60, file_["bending"] = 146, file_["shear"] = 5e3, file_["tangential"] = 5e4;
    file_["sidewall"] = {8.84e5, 5e5, 1e6}, file_["air_share"] = 0.55;
    file_.erase("tension_share");
    write("ring.json", file_.dump());
  }
  /// Forces of the other program with the file's values, and normal noise.
  void write_curve(const std::string& name, double pressure, double noise, std::uint64_t seed) {
    tire::RingParams p = tire::read_ring_file(file_, "ring.json").params;
    p.pressure = pressure;
    DenseRing ring(p);
    std::mt19937_64 bits(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::ofstream csv(folder_.path() / name);
    csv << "# noise of " << noise << " N\ndeflection_m,force_N,sigma_N\n";
    for (const double x : steps(0.003, 0.045, 15))
      csv << fmt::format("{:.17g},{:.17g},{}\n", x, ring.press(x) + noise * normal(bits), noise > 0.0 ? noise : 1.0);
  }
  Calibration study(const json& parameters, int starts = 1) {
    return load({{"calibrate", "ring"},
                 {"start", "ring.json"},
                 {"parameters", parameters},
                 {"targets",
                  {{{"data", "low.csv"}, {"on", "plate"}, {"pressure", 1e5}},
                   {{"data", "high.csv"}, {"on", "plate"}, {"pressure", 3e5}}}},
                 {"starts", starts}});
  }

  nlohmann::json file_;
};

TEST_F(CalibrateRing, parameters_are_found_again_from_curves_of_another_program) {
  write_curve("low.csv", 1e5, 0.0, 1), write_curve("high.csv", 3e5, 0.0, 1);
  const Calibration c = study({{"sidewall_1", {{"start", 6e5}}}, {"air_share", {{"start", 0.7}}}}, 2);
  const CalibrationResults results = calibrated(c);
  EXPECT_NEAR(results.values[0] / 8.84e5, 1.0, 2e-3);
  EXPECT_NEAR(results.values[1] / 0.55, 1.0, 2e-2);
  EXPECT_GT(joint_r_squared(c.model->targets(TargetSet::fitted), results.fitted.values), 0.99999);
}

TEST_F(CalibrateRing, the_belts_share_of_the_pressure_is_found_again) {
  file_["tension_share"] = 0.4;
  write_curve("low.csv", 1e5, 0.0, 1), write_curve("high.csv", 3e5, 0.0, 1);
  file_.erase("tension_share");  // optional in a file: the start is 0
  write("ring.json", file_.dump());
  const Calibration c = study({{"sidewall_1", {{"start", 6e5}}}, {"tension_share", json::object()}});
  const CalibrationResults results = calibrated(c);
  EXPECT_NEAR(results.values[0] / 8.84e5, 1.0, 2e-3);
  EXPECT_NEAR(results.values[1] / 0.4, 1.0, 1e-2);
  const nlohmann::json fitted = nlohmann::json::parse(c.model->fitted_file(results.values, "").dump());
  EXPECT_EQ(fitted["tension_share"], results.values[1]);
}

TEST_F(CalibrateRing, intervals_cover_what_made_noisy_curves) {
  constexpr int kTimes = 40;
  int covered = 0;
  for (int n = 0; n < kTimes; ++n) {
    write_curve("low.csv", 1e5, 40.0, 2 * n + 1), write_curve("high.csv", 3e5, 40.0, 2 * n + 2);
    const CalibrationResults results =
        calibrated(study({{"sidewall_1", {{"start", 6e5}}}, {"air_share", {{"start", 0.7}}}}));
    const auto holds = [&](int k, double truth) {
      const Estimate& e = results.confidence.estimates[k];
      return e.low.value_or(INFINITY) <= truth && truth <= e.high.value_or(-INFINITY);
    };
    covered += holds(0, 8.84e5), covered += holds(1, 0.55);
    EXPECT_NEAR(results.confidence.deviation, 1.0, 0.5);  // the noise is the file's
  }
  EXPECT_NEAR(covered / (2.0 * kTimes), 0.95, 0.08);  // three standard deviations
}

TEST_F(CalibrateRing, the_fitted_file_presses_as_the_calibration_predicts) {
  write_curve("low.csv", 1e5, 0.0, 1), write_curve("high.csv", 3e5, 0.0, 1);
  const Calibration c = study({{"sidewall_1", {{"start", 3e5}}}, {"softening", {{"start", 0.2}}}});
  const CalibrationResults results = calibrated(c);
  const nlohmann::json fitted = nlohmann::json::parse(c.model->fitted_file(results.values, "where from").dump());
  EXPECT_EQ(fitted["source"], "where from");
  tire::TireOptions options;
  options.file = folder_.path() / "fitted.json";
  options.pressure.knots = {{0.0, 1e5}};
  tire::PressOptions press;
  press.unload = false, press.load = INFINITY, press.points = 15, press.deflection = 0.045,
  press.at = c.model->targets(TargetSet::fitted)[0].x;
  const auto curve = tire::read_ring(fitted, options)->static_test()->press(press, {}).loading;
  ASSERT_EQ(curve.size(), 16u);
  for (int k = 0; k < 15; ++k) EXPECT_EQ(curve[k + 1].force, results.fitted.values[k]);
  EXPECT_EQ(fitted["sidewall"][0], results.values[0]);
}

// Stress is proportional to the modulus if the disc is stiffer by the same factor: F(δ; cE) = c F(δ; E).
TEST_F(CalibrateRing, a_planar_tire_twice_as_stiff_is_found) {
  nlohmann::json planar =
      nlohmann::json::parse(std::ifstream(data_folder() / "tire" / "data" / "aligator_planar.json"));
  planar["elements_circumference"] = 36, planar["elements_radial"] = 3;
  write("planar.json", planar.dump());
  nlohmann::json half = planar;
  half["tire"]["young_modulus"] = 0.5 * planar["tire"]["young_modulus"].get<double>();
  half["disc"]["young_modulus"] = 0.5 * planar["disc"]["young_modulus"].get<double>();
  half["contact_stiffness"] = 0.5 * planar["contact_stiffness"].get<double>();
  write("half.json", half.dump());
  write("made.csv", "deflection_m,force_N\n0.01,1\n0.02,1\n0.03,1\n");
  const Calibration of_half = load({{"calibrate", "planar"},
                                    {"start", "half.json"},
                                    {"parameters", {{"young_modulus", json::object()}}},
                                    {"targets", {{{"data", "made.csv"}, {"on", "plate"}}}},
                                    {"starts", 1}});
  const Prediction soft =
      of_half.model->predict(std::vector<double>{half["tire"]["young_modulus"].get<double>()}, TargetSet::fitted, {});
  ASSERT_EQ(soft.values.size(), 3u) << soft.problem;
  std::string curve = "deflection_m,force_N\n";
  for (int k = 0; k < 3; ++k) curve += fmt::format("{},{:.17g}\n", 0.01 * (k + 1), 2.0 * soft.values[k]);
  write("curve.csv", curve);
  const CalibrationResults results = calibrated(load({{"calibrate", "planar"},
                                                      {"start", "planar.json"},
                                                      {"parameters", {{"young_modulus", {{"start", 1e5}}}}},
                                                      {"targets", {{{"data", "curve.csv"}, {"on", "plate"}}}},
                                                      {"starts", 2}}));
  EXPECT_NEAR(results.values[0] / planar["tire"]["young_modulus"].get<double>(), 1.0, 1e-5);
}

}  // namespace
}  // namespace furrow::calibrate::calibrate_ring_test
