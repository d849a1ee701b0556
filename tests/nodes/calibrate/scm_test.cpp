// The kind `scm`: soil parameters from curves of plate and shear tests, compared with the laws that made the curves and
// with the fits of `furrow soil`.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/soil/fits.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tests/refusal.hpp"

namespace furrow::calibrate {
namespace {

using namespace testing;

constexpr double kC = -7e3, kPhi = 2.1e5, kN = 0.6, kCohesion = 2e3, kAngle = 28.0, kK = 0.012;

class CalibrateScm : public StudyTest {
 protected:
  void SetUp() override {
    write("soil.json", R"({"format_version": 1, "description": "none", "terrain": {"unloading_stiffness": 1e8}})");
    write_curves(0.0, 1);
  }
  void write_curves(double noise, std::uint64_t seed) {
    std::mt19937_64 bits(seed);
    std::normal_distribution<double> normal(0.0, noise > 0.0 ? noise : 1.0);
    const auto off = [&] { return noise > 0.0 ? normal(bits) : 0.0; };
    std::string plate = "seed,width_m,sinkage_m,pressure_Pa\n",
                shear = "seed,nominal_normal_stress_Pa,travel_m,shear_stress_Pa,normal_stress_Pa,rise_m\n";
    for (const double b : {0.05, 0.1})
      for (const double z : steps(0.004, 0.08, 20))
        plate += fmt::format("1,{},{:.17g},{:.17g}\n", b, z, (kC / b + kPhi) * std::pow(z, kN) + off());
    for (const double s : {20e3, 50e3})
      for (const double j : steps(0.002, 0.06, 20))
        shear += fmt::format(
            "1,{},{:.17g},{:.17g},{},0\n", s, j,
            (kCohesion + 1.01 * s * std::tan(kAngle * std::numbers::pi / 180.0)) * -std::expm1(-j / kK) + off(),
            1.01 * s);
    write("plate.csv", plate), write("shear.csv", shear);
  }
  static json good() {
    return {{"calibrate", "scm"},
            {"start", "soil.json"},
            {"parameters",
             {{"bekker_k_c", json::object()},
              {"bekker_k_phi", json::object()},
              {"bekker_n", json::object()},
              {"mohr_cohesion", json::object()},
              {"mohr_friction_angle", json::object()},
              {"janosi_k", json::object()}}},
            {"targets", {{{"data", "plate.csv"}, {"on", "plate"}}, {{"data", "shear.csv"}, {"on", "shear"}}}},
            {"starts", 1}};
  }
};

TEST_F(CalibrateScm, parameters_of_exact_curves_are_found_from_far) {
  json study = good();
  study["parameters"]["bekker_n"]["start"] = 1.2, study["parameters"]["bekker_k_phi"]["start"] = 5e6;
  study["parameters"]["mohr_friction_angle"]["start"] = 10, study["parameters"]["janosi_k"]["start"] = 0.1;
  const Calibration c = load(study);
  ASSERT_EQ(c.model->targets(TargetSet::fitted).size(), 4u);
  EXPECT_EQ(c.model->targets(TargetSet::fitted)[0].name, "plate 50 mm");
  EXPECT_EQ(c.model->targets(TargetSet::fitted)[3].name, "shear 50 kPa");
  const CalibrationResults results = calibrated(c);
  const double truth[] = {kC, kPhi, kN, kCohesion, kAngle, kK};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(results.values[k] / truth[k], 1.0, 1e-4) << c.parameters[k].name;
  const json fitted = json::parse(c.model->fitted_file(results.values, "where from").dump());
  EXPECT_EQ(fitted["terrain"]["bekker_n"], results.values[2]);
  EXPECT_EQ(fitted["terrain"]["unloading_stiffness"], 1e8);
  EXPECT_EQ(fitted["description"], "where from");
}

TEST_F(CalibrateScm, the_fitted_soil_says_nothing_of_the_start_s_grains) {
  write("soil.json",
        R"({"format_version": 1, "terrain": {"law": "mindlin", "friction": 0.5, "unloading_stiffness": 1e8,
           "bekker_n": 0.5},
                         "measured": {"grain_radius_m": 0.01}})");
  const Calibration c = load(good());
  const json fitted =
      json::parse(c.model->fitted_file(std::vector<double>{kC, kPhi, kN, kCohesion, kAngle, kK}, "where from").dump());
  EXPECT_FALSE(fitted.contains("measured"));
  EXPECT_FALSE(fitted["terrain"].contains("law"));
  EXPECT_FALSE(fitted["terrain"].contains("friction"));
  EXPECT_EQ(fitted["terrain"]["unloading_stiffness"], 1e8);
  EXPECT_EQ(fitted["terrain"]["bekker_n"], kN);
}

TEST_F(CalibrateScm, starts_are_the_fits_of_the_soil_tests) {
  const Calibration c = load(good());
  const double truth[] = {kC, kPhi, kN, kCohesion, kAngle, kK};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(c.parameters[k].start / truth[k], 1.0, 1e-2) << c.parameters[k].name;
}

// With equal weights, c and φ of the joint fit differ from those of furrow soil by less than their errors.
TEST_F(CalibrateScm, noisy_curves_are_met_within_the_errors) {
  write_curves(600.0, 7);
  json study = good();
  for (json& target : study["targets"]) target["sigma"] = 600.0;
  const CalibrationResults results = calibrated(load(study));
  const double truth[] = {kC, kPhi, kN, kCohesion, kAngle, kK};
  for (int k = 0; k < 6; ++k)
    EXPECT_LT(std::abs(results.values[k] - truth[k]), 3.5 * results.confidence.estimates[k].standard_error.value())
        << k;
  EXPECT_NEAR(results.confidence.deviation, 1.0, 0.25);
}

TEST_F(CalibrateScm, one_plate_does_not_tell_k_c_from_k_phi) {
  write("one.csv",
        "width_m,sinkage_m,pressure_Pa\n0.05,0.01,5000\n0.05,0.02,7600\n0.05,0.03,9700\n0.05,0.05,13100\n0.05,0.08,"
        "17500\n");
  json study = good();
  study["parameters"] = {
      {"bekker_k_c", {{"start", 1e3}}}, {"bekker_k_phi", {{"start", 1e5}}}, {"bekker_n", {{"start", 0.8}}}};
  study["targets"] = {{{"data", "one.csv"}, {"on", "plate"}}};
  const Calibration c = load(study);
  const CalibrationResults results = calibrated(c);
  ASSERT_EQ(results.confidence.undetermined.size(), 1u);
  const std::string text = combination_text(c.parameters, results.confidence.undetermined[0].direction);
  EXPECT_TRUE(holds(text, "bekker_k_c"));
  EXPECT_TRUE(holds(text, "bekker_k_phi"));
  EXPECT_TRUE(results.confidence.estimates[2].standard_error);
}

TEST_F(CalibrateScm, wrong_targets_are_refused) {
  write("no_width.csv", "sinkage_m,pressure_Pa\n0.01,5000\n");
  write("negative.csv", "width_m,sinkage_m,pressure_Pa\n-0.05,0.01,5000\n");
  write("empty.csv", "width_m,sinkage_m,pressure_Pa\n0.05,0,0\n");
  write("beds.csv", "width_m,sinkage_m,pressure_Pa,bed_depth_m\n0.05,0.01,5000,0.15\n0.05,0.01,3000,0.3\n");
  expect_refused(
      good(),
      {
          {"/targets/0/on", "cone", "key 'targets[0].on': is 'cone', expected 'plate' or 'shear'"},
          {"/targets/0/data", "shear.csv", "shear.csv: key 'line 1': column 'nominal_normal_stress_Pa' is unknown"},
          {"/targets/0/data", "no_width.csv", "has no column 'width_m'"},
          {"/targets/0/data", "negative.csv", "negative.csv: key 'line 2': width_m is -0.05, expected above 0"},
          {"/targets/0/data", "beds.csv", "key 'line 3': bed_depth_m is 0.3 m, and 0.15 m elsewhere, expected plates"},
          {"/targets/0/data", "empty.csv", "empty.csv: has no point with sinkage_m above 0"},
          {"/targets/0/normal_stress", 2e4, "key 'targets[0].normal_stress': is given with \"on\": \"plate\""},
          {"/targets/0/width", 0.05,
           "key 'targets[0].width': is given, and plate.csv has the column 'width_m', expected one of them"},
          {"/targets/1/normal_stress", 2e4,
           "key 'targets[1].normal_stress': is given, and shear.csv has the column 'nominal_normal_stress_Pa'"},
          {"/targets/1/pressure", 2e4, "key 'targets[1].pressure': is unknown"},
          {"/start", "plate.csv", "plate.csv"},
      });
  json one = good();
  one["targets"] = {{{"data", "no_width.csv"}, {"on", "plate"}, {"width", 0.05}}};
  one["parameters"] = {{"bekker_k_c", json::object()}};
  EXPECT_TRUE(holds(complaint(one), "key 'parameters.bekker_k_c': has no 'start'"));
}

}  // namespace
}  // namespace furrow::calibrate
