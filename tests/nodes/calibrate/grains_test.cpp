// Grains fitted to the strength of a soil: errors of such studies, and agreement of predictions with the soil tests.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "nodes/calibrate/study.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/soil_material.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/soil_tests.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tests/refusal.hpp"

namespace furrow::calibrate {
namespace {

using namespace testing;

class CalibrateGrains : public StudyTest {
 protected:
  static json good() {
    return {{"calibrate", "grains"},
            {"start", "drawbar_pull_small_report_soil.json"},
            {"set", {{"terrain.material", "loose_sand.json"}}},
            {"tests", {{"seeds", 1}, {"stresses", {20e3, 60e3}}, {"speed", 1.0}}},
            {"evaluations", 20},
            {"parameters",
             {{"rolling_friction", {{"lower", 0}, {"upper", 0.6}}}, {"cohesion", {{"lower", 0}, {"upper", 60e3}}}}},
            {"targets",
             {{{"quantity", "friction_angle_deg"}, {"data", "lete_sand.json"}, {"sigma", 1.0}},
              {{"quantity", "cohesion_Pa"}, {"value", 1300.0}, {"sigma", 300.0}}}}};
  }
};

TEST_F(CalibrateGrains, a_study_is_read) {
  const Calibration c = load(good());
  EXPECT_EQ(c.evaluations, 20);
  EXPECT_EQ(c.result, "drawbar_pull_small_report_soil_fitted.json");
  EXPECT_EQ(c.parameters[0].start, 0.2);  // of the material
  const auto& targets = c.model->targets(TargetSet::fitted);
  EXPECT_EQ(targets[0].y, std::vector<double>{31.1});  // of the soil file
  EXPECT_EQ(targets[0].what, "lete_sand.json");
  EXPECT_EQ(targets[1].sigma, std::vector<double>{300.0});
  json without = good();
  without.erase("evaluations"), without.erase("tests");
  EXPECT_EQ(load(without).evaluations, 16);
}

TEST_F(CalibrateGrains, wrong_studies_are_refused_with_file_and_key) {
  const json more{{"quantity", "janosi_K_m"}, {"value", 0.02}, {"sigma", 0.003}};
  expect_refused(
      good(),
      {
          {"/evaluations", 7, "key 'evaluations': is 7, expected a whole number from 8 to 1000"},
          {"/evaluations", 9.5, "key 'evaluations'"},
          {"/start", "hmmwv_ring.json", "hmmwv_ring.json"},
          {"/start", "rigid_ground.json", "key 'terrain.material': is a key of engine"},
          {"/set/terrain.frction", 0.5, "key 'terrain.frction'"},
          {"/set/terrain.cohesion", 5, "key 'set.terrain.cohesion': is a parameter too, expected its 'start' there"},
          {"/set", 3, "key 'set'"},
          {"/tests", 3, "key 'tests'"},
          {"/tests/seeds", 0, "key 'tests.seeds': is 0, expected a whole number from 1 to 100"},
          {"/tests/speed", 20, "key 'tests.speed': is 20 m/s, expected above 0 up to 10 m/s"},
          {"/tests/stresses", {1e3}, "key 'tests.stresses': expected two to 10 different normal stresses"},
          {"/tests/stresses", {1e3, 1e3}, "key 'tests.stresses': expected two to 10 different normal stresses"},
          {"/tests/stresses", {-1e3, 1e3}, "key 'tests.stresses': has -1000 Pa, expected each above 0 up to 1e7 Pa"},
          {"/tests/stress", 5, "key 'tests.stress': is unknown, expected 'stresses'?"},
          {"/parameters/rolling", json::object(),
           "key 'parameters.rolling': is unknown, expected one of: friction, rolling_friction"},
          {"/parameters/settling_friction", json::object(), "key 'parameters.settling_friction': has no 'start'"},
          {"/parameters/friction", json::object(),
           "key 'targets': has 2 points, expected as many as there are parameters, 3"},
          {"/targets/0/quantity", "friction_angle",
           "key 'targets[0].quantity': 'friction_angle' is unknown, expected one of: friction_angle_deg"},
          {"/targets/0/quantity", "cone_index_Pa",
           "lete_sand.json: key 'terrain': is missing: soil files do not say cone_index_Pa"},
          {"/targets/0/data", "dry_soil.json", "key 'targets[0].data'"},
          {"/targets/0/value", 30.0, "key 'targets[0].value': expected either 'value' or 'data'"},
          {"/targets/1/value", nullptr, "key 'targets[1].value': expected either 'value' or 'data'"},
          {"/targets/1/value", -5.0, "key 'targets[1].value': is -5, expected 0 to 1e7 for cohesion_Pa"},
          {"/held_out",
           {{{"quantity", "repose_angle_without_cohesion_deg"}, {"value", 400.0}, {"sigma", 1.0}}},
           "key 'held_out[0].value': is 400, expected 0 to 60 for repose_angle_without_cohesion_deg"},
          {"/targets/1/sigma", 0, "key 'targets[1].sigma'"},
          {"/targets/1/sigma", nullptr, "key 'targets[1].sigma': is missing, expected the standard error"},
          {"/targets/1/quantity", "friction_angle_deg",
           "key 'targets[1].quantity': is friction_angle_deg a second time"},
          {"/targets/1/on", "plate", "key 'targets[1].on': is unknown"},
          {"/targets/1/name", "a,b", "key 'targets[1].name': expected a name without commas"},
          {"/held_out",
           {{{"quantity", "cohesion_Pa"}, {"value", 1.0}, {"sigma", 1.0}}},
           "key 'held_out[0].quantity': is cohesion_Pa a second time"},
      });
  // Only the keys of this kind are allowed.
  for (const char* key : {"set", "tests", "evaluations"}) {
    json study{{"calibrate", "ring"}, {key, 1}};
    EXPECT_TRUE(holds(complaint(study), std::string("key '") + key + "': is unknown")) << key;
  }
}

TEST_F(CalibrateGrains, a_K_below_what_grains_of_the_size_have_is_told_and_not_fitted) {
  json study = good();
  study["targets"].push_back({{"quantity", "janosi_K_m"}, {"value", 2e-3}, {"sigma", 1e-3}});
  const Calibration c = load(study);
  ASSERT_EQ(c.model->notes().size(), 1u);
  EXPECT_TRUE(holds(c.model->notes()[0], "janosi_K_m of 2 mm cannot be reached with grains of 20 mm diameter"));
  EXPECT_EQ(c.model->targets(TargetSet::fitted).size(), 2u);
  EXPECT_EQ(c.model->targets(TargetSet::held_out).size(), 1u);
  // If too few are left, the message gives the reason.
  json few = study;
  few["targets"].erase(std::size_t{0});
  EXPECT_TRUE(
      holds(complaint(few), "has 1 points, expected as many as there are parameters, 2; janosi_K_m of 2 mm cannot"));
  // If the size is a parameter, it can follow.
  study["parameters"]["radius"] = {{"lower", 1e-3}, {"upper", 0.012}, {"start", 0.01}};
  EXPECT_TRUE(load(study).model->notes().empty());
}

TEST_F(CalibrateGrains, a_prediction_is_what_the_soil_tests_give_and_the_result_is_a_soil_file) {
  json study = good();
  study["held_out"] = {{{"quantity", "bulk_density_kg_m3"}, {"value", 1300.0}, {"sigma", 50.0}}};
  const Calibration c = load(study);
  const std::vector<double> values{0.3, 20e3};
  const Prediction found = c.model->predict(values, TargetSet::fitted, {}),
                   beside = c.model->predict(values, TargetSet::held_out, {});
  ASSERT_TRUE(found.problem.empty()) << found.problem;
  EXPECT_GT(found.processor_time, 0.0);
  EXPECT_EQ(beside.processor_time, 0.0);  // of the same tests

  terrain::soil::SoilOptions options;
  options.material = scenario::load_scenario(c.start, {{"terrain.material", "loose_sand.json"},
                                                       {"terrain.rolling_friction", "0.3"},
                                                       {"terrain.cohesion", "20000"}})
                         .grains("");
  options.seeds = 1, options.speed = 1.0, options.stresses = {20e3, 60e3};
  options.plate = options.cone = options.repose = false;
  const auto plan = terrain::soil::soil_plan(options);
  const auto results = terrain::soil::run_soil_tests(options, plan, {});
  const auto p = terrain::soil::soil_parameters(results, plan, options.material.radius);
  EXPECT_EQ(found.values, (std::vector<double>{p.phi.value / (std::numbers::pi / 180.0), p.cohesion.value}));
  EXPECT_EQ(beside.values, std::vector<double>{results.shear.front().specimen.bulk_density});

  write("fitted.json", c.model->fitted_file(values, "by hand").dump());
  const auto soil = scenario::read_soil_material(folder_.path() / "fitted.json");
  EXPECT_EQ(soil["rolling_friction"], 0.3);
  EXPECT_EQ(soil["cohesion"], 20e3);
  EXPECT_EQ(soil["size_spread"], 0.3);
}

/// A curve of `furrow soil` on the initial grains, and a study with this target.
class CalibrateGrainsOnCurves : public CalibrateGrains {
 protected:
  static json curve_study() {
    json study = good();
    study["tests"].erase("stresses");
    study["parameters"] = {{"friction", {{"lower", 0.2}, {"upper", 0.9}}}, {"settling_friction", {{"start", 0.1}}}};
    study["targets"] = {{{"data", "plate.csv"}, {"disc", 0.08}, {"depth", 0.13}, {"points", 4}}};
    return study;
  }
};

TEST_F(CalibrateGrainsOnCurves, a_measured_curve_is_recovered_by_the_grains_that_made_it) {
  const std::vector<double> truth{0.5, 0.2};  // another packing than without settling_friction
  terrain::soil::SoilOptions options;
  options.material =
      scenario::load_scenario("drawbar_pull_small_report_soil.json",
                              {{"terrain.material", "loose_sand.json"}, {"terrain.settling_friction", "0.2"}})
          .grains("");
  options.seeds = 1, options.speed = 1.0;
  options.shear = options.cone = options.repose = false;
  terrain::soil::SoilPlan plan;
  plan.plate_beds = {plate_bed(options, {plate_test(options, 0.08, true, 0.05)}, 0.13)};
  const auto results = terrain::soil::run_soil_tests(options, plan, {});
  std::string csv = "sinkage_m,pressure_Pa\n";
  const terrain::soil::PlateCurve& curve = results.plate[0][0].result.curve;
  for (std::size_t k = 0; k < curve.sinkage.size(); ++k)
    csv += fmt::format("{:.9g},{:.9g}\n", curve.sinkage[k], curve.pressure[k]);
  write("plate.csv", csv);

  const Calibration c = load(curve_study());
  const Target& target = c.model->targets(TargetSet::fitted)[0];
  EXPECT_EQ(target.what, "disc 80 mm on 130 mm");
  ASSERT_EQ(target.y.size(), 4u);
  EXPECT_NEAR(target.x.front(), 0.02, 1e-12);  // the diameter of a grain
  EXPECT_EQ(target.sigma[2], 0.1 * target.y[2]);
  const Prediction there = c.model->predict(truth, TargetSet::fitted, {}),
                   elsewhere = c.model->predict(std::vector{0.5, 0.0}, TargetSet::fitted, {});
  ASSERT_TRUE(there.problem.empty()) << there.problem;
  ASSERT_EQ(there.values.size(), 4u);
  double off = 0.0, farther = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    off = std::max(off, std::abs(there.values[k] / target.y[k] - 1.0));
    farther = std::max(farther, std::abs(elsewhere.values[k] / target.y[k] - 1.0));
  }
  EXPECT_LT(off, 0.02);  // the plate is pushed a little less deep, so its samples differ
  EXPECT_GT(farther, 0.2);
}

TEST_F(CalibrateGrainsOnCurves, wrong_curves_are_refused_with_file_and_key) {
  write("plate.csv", "sinkage_m,pressure_Pa\n0,0\n0.02,5000\n0.05,9000\n");
  write("short.csv", "sinkage_m,pressure_Pa\n0,0\n0.01,5000\n");
  write("pulled.csv", "sinkage_m,pressure_Pa\n0,0\n0.02,-500\n0.05,9000\n");
  write("kpa.csv", "sinkage_m,pressure_Pa\n0,0\n0.02,50\n0.05,90\n");
  write("other.csv", "sinkage_m,pressure_Pa,bed_depth_m\n0,0,0.2\n0.02,500,0.2\n0.05,9000,0.2\n");
  const double last = 9000.0 - 0.5 * 0.005 * 4000.0 / 0.03;
  EXPECT_EQ(load(curve_study()).model->targets(TargetSet::fitted)[0].y.back(), last);
  // Of a table of several plates and beds, only the curve of this plate on this bed counts.
  write("plates.csv",
        "sinkage_m,pressure_Pa,width_m,diameter_m,bed_depth_m\n"
        "0,0,0.04,0.08,0.127\n0.02,5000,0.04,0.08,0.127\n0.05,9000,0.04,0.08,0.127\n"
        "0.025,20,0.04,0.08,0.26\n0.03,10,0.08,0,0.127\n0.04,10,0.04,0.1,0.127\n");
  json several = curve_study();
  several["targets"][0]["data"] = "plates.csv";
  EXPECT_EQ(load(several).model->targets(TargetSet::fitted)[0].y.back(), last);
  expect_refused(curve_study(),
                 {
                     {"/targets/0/depth", nullptr, "key 'targets[0].depth': is missing, expected the depth of the bed"},
                     {"/targets/0/depth", 0.05, "plate.csv: key 'sinkage_m': ends at 0.05 m, expected less than half"},
                     {"/targets/0/strip", 0.1, "key 'targets[0].disc': expected either 'disc', a diameter, or 'strip'"},
                     {"/targets/0/disc", -1, "key 'targets[0].disc'"},
                     {"/targets/0", json{{"data", "plate.csv"}, {"disk", 0.08}},
                      "key 'targets[0].quantity': is missing, expected it, or for a plate's curve 'disc' or 'strip'"},
                     {"/targets/0/points", 1, "key 'targets[0].points': is 1, expected a whole number from 2 to 20"},
                     {"/targets/0/data", "other.csv",
                      "other.csv: has 0 points of this plate on a bed of this depth with a sinkage of 0 or more"},
                     {"/targets/0/data", "short.csv", "short.csv: key 'sinkage_m': ends at 0.01 m, expected 0.024 m"},
                     {"/targets/0/data", "pulled.csv", "pulled.csv: key 'pressure_Pa': is"},
                     {"/targets/0/data", "kpa.csv", "kpa.csv: key 'pressure_Pa': is 48.5 Pa at 0.02 m, expected Pa"},
                     {"/targets/0/quantity", "n", "key 'targets[0].quantity': is unknown"},
                 });
}

}  // namespace
}  // namespace furrow::calibrate
