// The planar tire as a tire: its file, errors in files, and results of furrow press.
#include "tire/planar/planar_spec.hpp"
#include "tests/refusal.hpp"

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

const std::filesystem::path kFile = TIRE_DATA "/aligator_planar.json";

json file_text() { return json::parse(std::ifstream(kFile)); }

std::string complaint(const json& file, const TireOptions& options = {}) {
  return complaint_of(read_planar, file, options);
}

TireOptions options(int around = 36) { return options_of(kFile, around); }

TEST(PlanarSpec, wrong_files_are_refused_with_file_key_and_what_was_expected) {
  const std::vector<WrongValues> wrong{
      {"/radius", {0, "wide"}, "expected"},
      {"/radius", {1e300}, "expected a number, 0.0001 to 100 m"},
      {"/rim_radius", {nullptr}, "expected"},
      {"/rim_radius", {5e-324}, "expected a number, 0.0001 to 100 m"},
      {"/rim_radius", {0.6}, "expected less than the radius of 0.522 m"},
      {"/width", {-0.2}, "expected"},
      {"/elements_circumference", {11, 72.5}, "expected"},
      {"/elements_radial", {0, 201}, "expected"},
      {"/disc", {7}, "expected"},
      {"/disc/density", {0}, "expected"},
      {"/disc/young_modulus", {-1e8}, "expected"},
      {"/tire/poisson_ratio", {0.5}, "expected a number, 0 to 0.499"},
      {"/tire/poisson_ratio", {-0.1}, "expected"},
      {"/tire/viscosity", {-1}, "expected"},
      {"/tire/shear_modulus", {1e5}, "poisson_ratio"},
      {"/law", {"hooke"}, "expected 'printed' or 'consistent'"},
      {"/volume", {2}, "expected"},
      {"/volume", {"nodal"}, "expected 'averaged' or 'element'"},
      {"/integrator", {"leapfrog"}, "expected 'semi_implicit_euler' or 'runge_kutta_4'"},
      {"/contact_law", {"hertz"}, "expected 'terrain' or 'penalty'"},
      {"/disc_in_run", {"stiff"}, "expected 'rigid' or 'elastic'"},
      {"/step_share", {0}, "expected"},
      {"/step_share", {1.2}, "expected a number, above 0 up to 1"},
      {"/contact_stiffness", {0}, "expected"},
      {"/contact", {3}, "expected"},
      {"/pressure", {2e5}},
      {"/format_version", {2}, "expected"}};
  json whole = file_text();
  whole["contact_law"] = "penalty", whole["disc_in_run"] = "elastic";
  expect_keys_are_checked(read_planar, whole, wrong,
                          {"radius", "rim_radius", "width", "elements_circumference", "elements_radial", "disc", "tire",
                           "step_share", "contact_stiffness", "contact"},
                          {"law", "volume", "integrator", "contact_law", "disc_in_run"});
  json file = file_text();
  file["elements_circumference"] = 12, file["elements_radial"] = 14;
  EXPECT_EQ(complaint(file),
            "tire.json: key 'elements_radial': is 14, expected 1 to 13 for 12 elements around: more cut each "
            "other");
}

TEST(PlanarSpec, values_in_another_unit_are_named_with_their_key) {
  const auto odd_keys = [](const json& file) {
    TireOptions o;
    o.file = "tire.json";
    std::string keys;
    for (const auto& [key, what] : read_planar(file, o)->unlikely_values()) keys += key + " ";
    return keys;
  };
  EXPECT_EQ(odd_keys(file_text()), "");
  json file = file_text();
  file["disc"]["density"] = 0.74;          // g/cm³
  file["tire"]["young_modulus"] = 0.2874;  // MPa
  file["contact"]["friction"] = 80;        // per cent
  EXPECT_EQ(odd_keys(file), "disc.density tire.young_modulus contact.friction ");
}

TEST(PlanarSpec, a_scenario_may_change_friction_and_the_mesh) {
  TireOptions o = options(36);
  o.friction = 0.3;
  const auto spec = read_tire(o);
  EXPECT_NEAR(spec->describe().mass.mass, 60.0, 1.0);
  EXPECT_EQ(idle_keys(*spec), std::vector<std::string>());
  EXPECT_EQ(spec->shape().material.friction, 0.3);
  EXPECT_EQ(spec->describe().facets, 36);
  EXPECT_TRUE(holds(spec->describe().details, "36 x 8 triangles"));
  EXPECT_GT(spec->describe().model.of("step_limit_s"), 1e-6);
  o.pressure.knots = {{0.0, 1e5}};
  EXPECT_EQ(idle_keys(*read_tire(o)), std::vector<std::string>{"pressure"});  // another pressure is another material
  o.elements_circumference = 8;
  EXPECT_TRUE(holds(complaint(file_text(), o), "expected 12 to 2000"));
}

TEST(PlanarSpec, the_penalty_contact_is_its_own_and_takes_the_grip_of_the_ground) {
  json file = file_text();
  TireOptions o;
  o.file = "tire.json";
  EXPECT_EQ(read_planar(file, o)->describe().own_contact, "");
  file["contact_law"] = "penalty", file["integrator"] = "runge_kutta_4";
  const auto spec = read_planar(file, o);
  EXPECT_TRUE(holds(spec->describe().own_contact, "contact_law"));
  EXPECT_TRUE(spec->describe().own_contact_in_plane);
  EXPECT_EQ(spec->describe().static_only, "");
  for (const double ground : {0.3, 2.0}) {
    const auto tire = spec->make({.ground_friction = ground});
    RimState rim;
    rim.position.z() = 0.522 - 2e-5;
    rim.velocity.x() = 5.0;  // slides
    RimTrajectory motion(rim);
    tire->place(rim);
    motion.extend(rim, 1e-4);
    ASSERT_TRUE(tire->advance(motion, {}, 1).ok);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& force : tire->stated_contact()->forces.force) sum += force;
    EXPECT_NEAR(sum.x(), -std::min(ground, 0.8) * sum.z(), 1e-9 * sum.z());
  }
}

TEST(PlanarSpec, pressing_gives_curve_and_footprint) {
  PressOptions press;
  press.deflection = 0.08, press.points = 4, press.load = 15000.0;
  const PressResults r = pressed(options(), press);
  expect_curve_and_footprint(press, r, 1e-6, 0.01);  // a patch's sides are not all level
  const json summary = press_json(press, r);
  EXPECT_TRUE(summary["pressure_Pa"].is_null());
  EXPECT_EQ(summary["footprint"]["width_m"], 1.0);
}

TEST(PlanarSpec, cleats_and_profiles) {
  PressOptions press;
  press.deflection = 0.04, press.points = 2, press.unload = false;
  const double plate = pressed(options(72), press).loading.back().force;
  press.obstacle.height = 0.1, press.obstacle.width = 0.08;
  const double middle = pressed(options(72), press).loading.back().force;
  EXPECT_LT(middle, 0.97 * plate);
  press.obstacle.position = 0.15;
  EXPECT_LT(pressed(options(72), press).loading.back().force, middle);
  press.obstacle = {};
  press.obstacle.profile = {{-1, 0.0}, {1, 0.0}};
  EXPECT_NEAR(pressed(options(72), press).loading.back().force, plate, 1e-9 * plate);
  press.deflection = 0.17;
  expect_refused(ExitCode::bad_input, {"key '--deflection': is 0.17 m, expected at most 0.1608 m"},
                 [&] { pressed(options(), press); });
}

}  // namespace
}  // namespace furrow::tire
