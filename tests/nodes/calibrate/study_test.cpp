// Calibration studies: their errors, their table of evaluations, and continuing.
#include "nodes/calibrate/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "nodes/calibrate/evaluations.hpp"
#include "nodes/calibrate/explain.hpp"
#include "nodes/calibrate/kinds.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/nodes/calibrate/examples.hpp"
#include "tests/refusal.hpp"

namespace furrow::calibrate {
namespace {

using namespace testing;

class CalibrateStudy : public StudyTest {
 protected:
  void SetUp() override {
    write("plate.csv", "# by hand\ndeflection_m,force_N\n0,0\n0.01,2000\n0.02,5000\n0.03,9000\n0.04,14000\n");
    write("cleat.csv", "deflection_m,force_N,sigma_N\n0.01,500,20\n0.02,1000,20\n0.03,1600,20\n");
  }
  static json good() {
    return {{"calibrate", "ring"},
            {"start", "hmmwv_ring.json"},
            {"parameters", {{"sidewall_1", {{"lower", 1e5}, {"upper", 1e7}}}, {"bending", json::object()}}},
            {"targets", {{{"data", "plate.csv"}, {"on", "plate"}, {"pressure", 200e3}}}},
            {"held_out", {{{"data", "cleat.csv"}, {"on", "cleat"}, {"cleat_width", 0.05}}}}};
  }
};

TEST_F(CalibrateStudy, a_study_is_read_with_its_defaults) {
  const Calibration c = load(good());
  EXPECT_EQ(c.kind->name, "ring");
  EXPECT_EQ(c.result, "hmmwv_ring_fitted.json");
  ASSERT_EQ(c.parameters.size(), 2u);
  EXPECT_EQ(c.parameters[0].name, "sidewall_1");
  EXPECT_EQ(c.parameters[0].start, 2.3534e5);  // of the tire's file
  EXPECT_TRUE(c.parameters[0].logarithmic);
  const Target& plate = c.model->targets(TargetSet::fitted).front();
  EXPECT_EQ(plate.x, (std::vector<double>{0.01, 0.02, 0.03, 0.04}));  // a point without deflection has no information
  EXPECT_EQ(plate.sigma, std::vector<double>(4, 140.0));              // a hundredth of the largest
  EXPECT_EQ(plate.what, "plate, 200 kPa");
  EXPECT_EQ(c.model->targets(TargetSet::held_out).front().sigma, std::vector<double>(3, 20.0));
  EXPECT_TRUE(c.model->notes().empty());
}

TEST(CalibrateExplain, every_key_kind_and_parameter_is_explained) {
  const auto explained = [](const std::string& key) { return explain_calibration(key).starts_with(key + "\n  "); };
  std::vector<std::string_view> names;
  for (const CalibrationKey& key : calibration_keys()) {
    EXPECT_TRUE(explained("calibrate." + std::string(key.name)));
    names.push_back(key.name);
  }
  for (const CalibrationKind& kind : calibration_kinds()) {
    const std::string name = "calibrate." + std::string(kind.name);
    EXPECT_TRUE(explained(name));
    for (const ParameterRule& rule : kind.parameters) EXPECT_TRUE(explained(name + "." + rule.name));
    for (const std::string_view key : kind.keys)
      EXPECT_NE(std::find(names.begin(), names.end(), key), names.end()) << key;
  }
  const std::string grains = explain_calibration("calibrate.grains");
  EXPECT_TRUE(holds(grains, "\nquantities of targets, with the range of their values\n"));
  EXPECT_TRUE(holds(grains, "\nrepose_angle_without_cohesion_deg    0 to 60\n"));
  EXPECT_EQ(explain_calibration("calibrate.ring").find("quantities"), std::string::npos);
  EXPECT_TRUE(explains_calibrations("calibrate"));
  EXPECT_FALSE(explains_calibrations("calibrates"));
  EXPECT_THROW(explain_calibration("calibrate."), Error);
  EXPECT_THROW(explain_calibration("calibrate.ring."), Error);
}

TEST_F(CalibrateStudy, a_pressure_in_another_unit_is_warned_of) {
  json study = good();
  study["targets"][0]["pressure"] = 200;
  const Calibration c = load(study);
  ASSERT_EQ(c.model->notes().size(), 1u);
  EXPECT_TRUE(holds(c.model->notes()[0], "key 'targets[0].pressure': 200 Pa is unusually small"));
}

TEST_F(CalibrateStudy, wrong_studies_are_refused_with_file_and_key) {
  write("empty.csv", "deflection_m,force_N\n0,0\n");
  write("falling.csv", "deflection_m,force_N\n0.02,1\n0.01,2\n");
  write("words.csv", "deflection_m,force_N\n0.01,many\n");
  write("columns.csv", "deflection_m,force_kN\n0.01,2\n");
  write("no_force.csv", "deflection_m,residual\n0.01,0\n");
  write("sigma.csv", "deflection_m,force_N,sigma_N\n0.01,5,0\n");
  write("none.csv", "deflection_m,force_N\n0,0\n0.01,0\n0.02,0\n");
  write("pulled.csv", "deflection_m,force_N\n0.01,500\n0.02,-1000\n");
  write("beyond.csv", "deflection_m,force_N\n0.1,5000\n0.15,9000\n");
  write("deep.csv", "deflection_m,force_N\n0.3,5\n");
  write("tire.json", R"({"format_version": 1, "model": "planar"})");
  write("soft.json", "{}");
  expect_refused(
      good(),
      {
          {"/calibrate", "rings", "key 'calibrate': 'rings' is unknown, expected 'ring'?"},
          {"/calibrate", 3, "key 'calibrate'"},
          {"/start", "nowhere.json", "key 'start'"},
          {"/start", "tire.json", "key 'model': is not 'ring'"},
          {"/start", "soft.json", "key 'model': is not 'ring'"},
          {"/parameters", json::object(), "key 'parameters': is empty"},
          {"/parameters", json::array(), "key 'parameters'"},
          {"/parameters/bendin", json::object(), "key 'parameters.bendin': is unknown, expected 'bending'?"},
          {"/parameters/bending", 5, "key 'parameters.bending': is 5, expected an object"},
          {"/parameters/bending/low", 5, "key 'parameters.bending.low': is unknown, expected 'lower'?"},
          {"/parameters/bending/lower", -5, "key 'parameters.bending.lower': is -5, expected 1e-9 to"},
          {"/parameters/bending/lower", "a", "key 'parameters.bending.lower'"},
          {"/parameters/bending/upper", 0.5, "key 'parameters.bending.upper': is 0.5, expected more than lower"},
          {"/parameters/bending/start", 1e7,
           "key 'parameters.bending.start': is 1e7, expected a value from lower to upper"},
          {"/parameters/bending/scale", "logarithmic", "key 'parameters.bending.scale'"},
          {"/parameters/sidewall_1/lower", 1e6, "key 'parameters.sidewall_1': begins at 235340 N/m"},
          {"/parameters/sidewall_2", {{"scale", "log"}}, "key 'parameters.sidewall_2.lower': is 0, expected above 0"},
          {"/parameters/softening", json::object(), "no error"},
          {"/parameters/tension_share", json::object(), "no error"},
          {"/parameters/tension_share",
           {{"upper", 1.5}},
           "key 'parameters.tension_share.upper': is 1.5, expected 0 to 1"},
          {"/targets", json::array(), "key 'targets': has 0 entries"},
          {"/targets/0", "plate.csv", "key 'targets[0]': is 'plate.csv', expected an object"},
          {"/targets/0/data", "nowhere.csv", "key 'targets[0].data'"},
          {"/targets/0/data", "none.csv", "none.csv: key 'line 4': force_N is 0 here and on all lines before"},
          {"/targets/0/data", "pulled.csv", "pulled.csv: key 'line 3': force_N is -1000, expected 0 or more"},
          {"/targets/0/data", "empty.csv", "empty.csv: has no point of loading"},
          {"/targets/0/data", "falling.csv", "falling.csv: key 'line 3': deflection_m is 0.01, expected more"},
          {"/targets/0/data", "words.csv", "words.csv: key 'line 2'"},
          {"/targets/0/data", "columns.csv",
           "columns.csv: key 'line 1': column 'force_kN' is unknown, expected 'force_N'?"},
          {"/targets/0/data", "no_force.csv", "no_force.csv: key 'line 2': has no column 'force_N'"},
          {"/targets/0/data", "sigma.csv", "sigma.csv: key 'line 2': sigma_N is 0, expected above 0"},
          {"/targets/0/data", "deep.csv", "deep.csv: key 'line 2': deflection_m is 0.3, expected 0 to 0.2"},
          {"/targets/0/data", "beyond.csv",
           "beyond.csv: key 'line 3': deflection_m is 0.15, expected 0.1175 or less, a quarter of the tire's radius"},
          {"/targets/0/on", "floor", "key 'targets[0].on': is 'floor', expected 'plate' or 'cleat'"},
          {"/targets/0/cleat_width", 0.05, "key 'targets[0].cleat_width': is given on a plate"},
          {"/targets/0/pressure", -1, "key 'targets[0].pressure'"},
          {"/targets/0/weight", 0, "key 'targets[0].weight'"},
          {"/targets/0/sigmas", 2, "key 'targets[0].sigmas': is unknown, expected 'sigma'?"},
          {"/targets/0/name", "cleat", "has the name 'cleat' twice"},
          {"/held_out/0/cleat_width", 2, "key 'held_out[0].cleat_width': is 2 m, expected above 0 up to 1 m"},
          {"/held_out", 1, "key 'held_out'"},
          {"/starts", 0, "key 'starts'"},
          {"/seed", 0.5, "key 'seed'"},
          {"/result", "sub/file.json", "key 'result'"},
          {"/result", "calibration.json", "key 'result'"},
          {"/result", "tire.txt", "key 'result'"},
          {"/target", json::array(), "key 'target': is unknown, expected 'targets'?"},
          {"/format_version", 2, "key 'format_version'"},
      });
  for (const char* key : {"calibrate", "start", "parameters", "targets"}) {
    json study = good();
    study.erase(key);
    EXPECT_TRUE(holds(complaint(study), std::string("key '") + key + "'"));
  }
  json both = good();
  both["parameters"]["softening"] = both["parameters"]["sidewall_2"] = json::object();
  EXPECT_TRUE(holds(complaint(both), "key 'parameters.softening': is given with sidewall_2"));
  json many = good();
  for (const char* name : {"shear", "sidewall_3", "air_share"}) many["parameters"][name] = json::object();
  EXPECT_TRUE(holds(complaint(many), "has 4 points, expected more than there are parameters, 5"));
  json planar = good();
  planar["calibrate"] = "planar", planar["start"] = "aligator_planar.json";
  planar["parameters"] = {{"young_modulus", json::object()}};
  EXPECT_TRUE(holds(complaint(planar), "key 'targets[0].pressure': is given for a planar tire"));
}

TEST_F(CalibrateStudy, evaluations_are_kept_to_the_bit_and_a_cut_line_is_left_out) {
  const std::vector<double> a{0.1, 1.0 / 3.0}, b{2e-300, -1.0};
  {
    EvaluationTable table(folder_.path(), "digest", {"p", "q"});
    table.add("fitted", a, {{1.0 / 7.0, 3e5}, {0.1}, ""});
    table.add("fitted", b, {{}, {}, "no \"answer\", at all\n"});
  }
  std::ofstream(folder_.path() / kEvaluations, std::ios::app) << "fitted,0.5,0.5,,1.0";  // killed in the middle
  {
    EvaluationTable table(folder_.path(), "digest", {"p", "q"});
    EXPECT_EQ(table.size(), 2u);
    ASSERT_TRUE(table.find("fitted", a));
    EXPECT_EQ(table.find("fitted", a)->values, (std::vector<double>{1.0 / 7.0, 3e5}));
    EXPECT_EQ(table.find("fitted", a)->errors, std::vector<double>{0.1});
    EXPECT_EQ(table.find("fitted", b)->problem, "no  answer ; at all ");
    EXPECT_FALSE(table.find("held_out", a));
    EXPECT_FALSE(table.find("fitted", std::vector<double>{0.1, 0.3}));
    table.add("held_out", a, {{2.0}, {}, ""});
  }
  EXPECT_EQ(EvaluationTable(folder_.path(), "digest", {"p", "q"}).size(), 3u);
  EXPECT_THROW(EvaluationTable(folder_.path(), "another", {"p", "q"}), Error);
  EXPECT_THROW(EvaluationTable(folder_.path(), "digest", {"p", "r"}), Error);
  std::ofstream(folder_.path() / kEvaluations, std::ios::app) << "fitted,0.5,zero,,1.0,\n";
  EXPECT_THROW(EvaluationTable(folder_.path(), "digest", {"p", "q"}), Error);
}

/// Stops once, after this number of evaluations.
struct Stopper {
  int left;
  void operator()(const std::string&, double) {
    if (--left == 0) throw Error(ExitCode::stopped, "stopped");
  }
};

TEST_F(CalibrateStudy, an_interrupted_calibration_ends_with_the_same_files) {
  const auto decay = [](double x, std::span<const double> p) {
    return p[0] * std::exp(-x / p[1]) + 0.3 * std::sin(9.0 * x);
  };
  const auto study = [&] {
    std::vector<double> y;
    for (const double x : steps(0.1, 3.0, 15)) y.push_back(50.0 * std::exp(-x / 0.8));
    return study_of(decay, steps(0.1, 3.0, 15), y,
                    {{"height", "-", 1.0, 1e3, 10.0, true}, {"length", "m", 0.01, 10.0, 0.3, true}}, 4);
  };
  const auto files = [&](const std::filesystem::path& folder, const Calibration& c, const CalibrationResults& results) {
    write_calibration(c, results, folder);
    std::string all;
    for (const char* name : {"calibration.json", "fit.csv", "fitted.json", kEvaluations})
      all += read_whole_file(folder / name);
    return all;
  };
  const std::filesystem::path once = folder_.path() / "once", often = folder_.path() / "often";
  std::filesystem::create_directory(once), std::filesystem::create_directory(often);
  const Calibration c = study();
  const std::string expected = files(once, c, calibrate(c, once, {}));
  int stops = 0;
  for (int calls = 5;; calls += 7) {
    const Calibration again = study();
    try {
      const CalibrationResults results = calibrate(again, often, Stopper{calls});
      EXPECT_LT(results.computed, results.asked);
      EXPECT_EQ(files(often, again, results), expected);
      break;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ExitCode::stopped);
      ++stops;
    }
  }
  EXPECT_GT(stops, 5);
  // Once more: nothing is computed.
  EXPECT_EQ(calibrate(c, once, {}).computed, 0u);
}

}  // namespace
}  // namespace furrow::calibrate
