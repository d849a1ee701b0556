// The planar tire as a tire: its file, what is wrong with files, and what furrow press finds.
#include "tire/planar/planar_spec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tests/tire/tire_file_checks.hpp"
#include "tire/outward.hpp"
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
  EXPECT_EQ(complaint(file_text()), "no error");
  const std::vector<std::tuple<const char*, json, const char*>> wrong{
      {"/radius", 0, "expected"},
      {"/radius", 1e300, "expected a number, 0.0001 to 100 m"},
      {"/rim_radius", 5e-324, "expected a number, 0.0001 to 100 m"},
      {"/radius", "wide", "expected"},
      {"/rim_radius", 0.6, "expected less than the radius of 0.522 m"},
      {"/rim_radius", nullptr, "expected"},
      {"/width", -0.2, "expected"},
      {"/elements_circumference", 11, "expected"},
      {"/elements_circumference", 72.5, "expected"},
      {"/elements_radial", 0, "expected"},
      {"/elements_radial", 201, "expected"},
      {"/disc", 7, "expected"},
      {"/disc/density", 0, "expected"},
      {"/disc/young_modulus", -1e8, "expected"},
      {"/tire/poisson_ratio", 0.5, "expected a number, 0 to 0.499"},
      {"/tire/poisson_ratio", -0.1, "expected"},
      {"/tire/viscosity", -1, "expected"},
      {"/tire/shear_modulus", 1e5, "poisson_ratio"},
      {"/law", "hooke", "expected 'printed' or 'consistent'"},
      {"/volume", 2, "expected"},
      {"/volume", "nodal", "expected 'averaged' or 'element'"},
      {"/integrator", "leapfrog", "expected 'semi_implicit_euler' or 'runge_kutta_4'"},
      {"/step_share", 0, "expected"},
      {"/step_share", 1.2, "expected a number, above 0 up to 1"},
      {"/contact_stiffness", 0, "expected"},
      {"/contact", 3, "expected"},
      {"/pressure", 2e5, ""},
      {"/format_version", 2, "expected"}};
  for (const auto& [pointer, value, words] : wrong) {
    json file = file_text();
    file[json::json_pointer(pointer)] = value;
    std::string key = std::string(pointer).substr(1);
    if (const auto slash = key.find('/'); slash != std::string::npos) key[slash] = '.';
    const std::string said = complaint(file);
    EXPECT_EQ(said.rfind("tire.json: key '" + key, 0), 0U) << pointer << " " << value << ": " << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
  for (const char* key : {"radius", "rim_radius", "width", "elements_circumference", "elements_radial", "disc", "tire",
                          "step_share", "contact_stiffness", "contact"}) {
    json file = file_text();
    file.erase(key);
    EXPECT_EQ(complaint(file).rfind("tire.json: key '" + std::string(key), 0), 0U) << complaint(file);
  }
  json file = file_text();
  file["elements_circumference"] = 12, file["elements_radial"] = 14;
  EXPECT_EQ(complaint(file),
            "tire.json: key 'elements_radial': is 14, expected 1 to 13 for 12 elements around: more cut each "
            "other");
  file = file_text();
  for (const char* key : {"law", "volume", "integrator"}) file.erase(key);
  EXPECT_EQ(complaint(file), "no error");
}

TEST(PlanarSpec, a_scenario_may_change_friction_and_the_mesh) {
  TireOptions o = options(36);
  o.friction = 0.3;
  const auto spec = read_tire(o);
  EXPECT_EQ(idle_keys(*spec), std::vector<std::string>());
  EXPECT_EQ(spec->shape().material.friction, 0.3);
  EXPECT_EQ(spec->describe().facets, 36);
  EXPECT_NE(spec->describe().details.find("36 x 8 triangles"), std::string::npos) << spec->describe().details;
  EXPECT_GT(spec->describe().model.of("step_limit_s"), 1e-6);
  o.pressure.knots = {{0.0, 1e5}};
  EXPECT_EQ(idle_keys(*read_tire(o)), std::vector<std::string>{"pressure"});  // another pressure is another material
  o.elements_circumference = 8;
  EXPECT_NE(complaint(file_text(), o).find("expected 12 to 2000"), std::string::npos);
}

TEST(PlanarSpec, it_may_be_held_rigid) {
  TireOptions o = options();
  const auto spec = read_tire(o);
  EXPECT_NEAR(spec->describe().mass.mass, 60.0, 1.0);
  o.rigid = true;
  const auto rigid = read_tire(o);
  const auto tire = rigid->make();
  tire->place(RimState());
  SurfaceState state;
  tire->surface(state);
  EXPECT_EQ(static_cast<int>(state.position.size()), rigid->describe().vertices);
  EXPECT_NO_THROW(require_outward(tire->mesh(), state.position, Vec3::Zero(), "tire.json"));
}

TEST(PlanarSpec, pressing_gives_curve_and_footprint) {
  PressOptions press;
  press.deflection = 0.08, press.points = 4, press.load = 15000.0;
  const PressResults r = pressed(options(), press);
  ASSERT_EQ(r.loading.size(), 5U);
  EXPECT_EQ(r.loading.front().force, 0.0);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(r.loading[k].force, r.loading[k + 1].force);
    EXPECT_NEAR(r.unloading[k].force, r.loading[3 - k].force, 1e-6 * r.loading.back().force);
  }
  EXPECT_NEAR(r.at_load.force, 15000.0, 15.0);
  double force = 0.0;
  for (const PressSample& s : r.footprint) force += s.pressure * s.area;
  EXPECT_NEAR(force, r.at_load.force, 0.01 * force);  // a patch's sides are not all level
  const json summary = press_json(press, r);
  EXPECT_TRUE(summary["pressure_Pa"].is_null());
  EXPECT_EQ(summary["footprint"]["width_m"], 1.0);
  EXPECT_TRUE(summary["statically_stable"]);
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
  try {
    pressed(options(), press);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("key '--deflection': is 0.17 m, expected at most 0.1608 m"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace furrow::tire
