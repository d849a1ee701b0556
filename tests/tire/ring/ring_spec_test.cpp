// The flexible ring as a tire: its file, errors in files, and results of furrow press.
#include "tire/ring/ring_spec.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tests/tire/tire_file_checks.hpp"
#include "tire/press/press.hpp"
#include "tire/tires.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

const std::filesystem::path kFile = TIRE_DATA "/hmmwv_ring.json";

json file_text() { return json::parse(std::ifstream(kFile)); }

std::string complaint(const json& file, const TireOptions& options = {}) {
  return complaint_of(read_ring, file, options);
}

TireOptions options(int segments = 120) { return options_of(kFile, segments); }

TEST(RingSpec, wrong_files_are_refused_with_file_and_key) {
  const auto list = [](std::vector<double> numbers) { return json(numbers); };
  const std::vector<WrongValues> wrong{
      {"/segments", {15, 20001, 48.5}},
      {"/radius", {0, "wide", 1e300}},
      {"/width", {1e-9, -0.2}},
      {"/rim_radius", {0.5, nullptr}},
      {"/pressure", {-1, 1e9}},
      {"/air_share", {0, 1.2}},
      {"/bending", {0, -140}},
      {"/shear", {json::array()}},
      {"/tangential", {0}},
      {"/tension_share", {-0.1, 1.5, "all"}},
      {"/sidewall", {8e5, list({8e5, 1e6}), list({0, 0, 0}), list({8e5, -1, 1e7}), list({8e5, 1e8, 1e6})}},
      {"/gas", {"ideal"}},
      {"/kinematics", {"polar", 1}},
      {"/mass", {0}},
      {"/spin_inertia", {-2, 0.8, 2.6}},
      {"/structural_damping", {-1e-3, "5 ms"}},
      {"/diametral_inertia", {false}},
      {"/contact", {3}},
      {"/format_version", {2}},
      {"/bending_stiffness", {140}}};
  const std::vector<const char*> optional{"gas", "kinematics", "structural_damping", "tension_share"};
  expect_keys_are_checked(read_ring, file_text(), wrong,
                          {"segments", "radius", "width", "rim_radius", "pressure", "air_share", "bending", "shear",
                           "sidewall", "tangential", "mass", "spin_inertia", "diametral_inertia", "contact"},
                          optional);
  json file = file_text();
  for (const char* key : optional) file.erase(key);
  TireOptions o;
  o.file = "tire.json";
  EXPECT_EQ(read_ring(file, o)->describe().damping_time, 5e-3);
  EXPECT_EQ(read_ring_file(file, "tire.json").params.tension_share, 0.0);
}

TEST(RingSpec, values_in_another_unit_are_named_with_their_key) {
  const auto odd_keys = [](const json& file) {
    TireOptions o;
    o.file = "tire.json";
    std::string keys;
    for (const auto& [key, what] : read_ring(file, o)->unlikely_values()) keys += key + " ";
    return keys;
  };
  EXPECT_EQ(odd_keys(file_text()), "");
  json file = file_text();
  file["pressure"] = 200;            // kPa
  file["structural_damping"] = 2.2;  // ms
  file["tangential"] = 250;          // kN/m
  file["contact"]["friction"] = 90;  // per cent
  file["sidewall"][0] = 235;         // kN/m
  file["sidewall"][1] = 0;
  EXPECT_EQ(odd_keys(file), "pressure tangential structural_damping contact.friction sidewall ");
}

TEST(RingSpec, a_scenario_may_change_pressure_friction_segments_and_damping) {
  TireOptions o = options(64);
  EXPECT_EQ(read_tire(o)->describe().damping_time, 0.00216);
  o.structural_damping = 0.01;
  o.pressure.knots = {{0.0, 1e5}};
  o.friction = 0.4;
  const auto spec = read_tire(o);
  EXPECT_EQ(idle_keys(*spec), std::vector<std::string>());
  EXPECT_EQ(spec->describe().coordinates, 128);
  EXPECT_EQ(spec->describe().damping_time, 0.01);
  EXPECT_EQ(spec->shape().material.friction, 0.4);
  PressOptions press;
  EXPECT_EQ(pressed(o, press).pressure, 1e5);
  EXPECT_LT(pressed(o, press).loading.back().force, pressed(options(64), press).loading.back().force);
  o.elements_circumference = 8;
  EXPECT_TRUE(holds(complaint(file_text(), o), "expected 16 to 20000"));
  o = options();
  o.pressure.knots = {{0.0, 1e5}, {1.0, 1e8}};
  EXPECT_TRUE(holds(complaint(file_text(), o), "a stiffer sidewall or less pressure"));
}

TEST(RingSpec, pressing_gives_curve_and_footprint) {
  PressOptions press;
  press.deflection = 0.03, press.points = 6, press.load = 6000.0;
  const PressResults r = pressed(options(480), press);
  expect_curve_and_footprint(press, r, 1e-7, 1e-6);
  for (const PressSample& s : r.footprint) {
    EXPECT_EQ(s.y, 0.0);
    EXPECT_GE(s.pressure, 0.0);
  }
  const json summary = press_json(press, r);
  EXPECT_NEAR(summary["footprint"]["width_m"], 0.24, 1e-12);
  EXPECT_TRUE(summary["inflation_growth_m"].is_null());
}

TEST(RingSpec, cleats_of_any_size_and_place_and_profiles) {
  PressOptions press;
  press.deflection = 0.05, press.points = 5;
  press.obstacle.height = 0.1, press.obstacle.width = 0.05;
  const double middle = pressed(options(), press).loading.back().force;
  press.obstacle.position = 0.1;
  const PressResults aside = pressed(options(), press);
  EXPECT_LT(aside.loading.back().force, middle);
  for (const PressSample& s : aside.footprint) EXPECT_NEAR(s.x, 0.1, 0.0251);
  press.obstacle = {};
  press.obstacle.profile = {{-0.025, 0.3}, {0.025, 0.3}};  // the bar again, at another height
  EXPECT_NEAR(pressed(options(), press).loading.back().force, middle, 1e-6 * middle);
  press.obstacle.profile = {{-1, 0}, {-0.1, 0}, {0.0, 0.02}, {0.1, 0.0}, {1, 0}};
  EXPECT_GT(pressed(options(), press).loading.back().force, 1000.0);
}

TEST(RingSpec, what_lies_beyond_the_model_is_refused) {
  PressOptions press;
  press.deflection = 0.12;
  expect_refused(ExitCode::bad_input, {"key '--deflection': is 0.12 m, expected at most 0.1175 m"},
                 [&] { pressed(options(), press); });
  json file = file_text();
  file["rim_radius"] = 0.44, file["spin_inertia"] = 2.3;
  TireOptions o;
  o.file = "tire.json";
  press.deflection = 0.05;
  EXPECT_THROW(read_ring(file, o)->static_test()->press(press, {}), Error);
}

TEST(PressProfile, is_read_from_csv_and_mistakes_name_their_line) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "profile.csv";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_press_profile(file);
  };
  const auto points = read("# a kerb\nx_m,z_m\n-1,0\r\n0.5,1e-2\n\n0.75,0.2\n");
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[1][1], 0.01);
  const std::pair<const char*, const char*> wrong[] = {{"0,0\n1,0\n", "line 1: expected the header x_m,z_m"},
                                                       {"x_m,z_m\n0,0\n1;0\n", "line 3: expected two numbers"},
                                                       {"x_m,z_m\n0,0,1\n", "line 2: expected two numbers"},
                                                       {"x_m,z_m\n0,nan\n", "line 2: expected two numbers"},
                                                       {"x_m,z_m\n0,0\n0,1\n", "line 3: x is 0 m, expected more"},
                                                       {"x_m,z_m\n0,0\n", "has 1 points, expected two at least"}};
  for (const auto& [text, words] : wrong) expect_refused(ExitCode::bad_input, {words}, [&] { read(text); });
}

}  // namespace
}  // namespace furrow::tire
