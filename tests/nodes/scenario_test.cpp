// What the loader makes of a scenario: defaults from the schema, settings, digests, starting places.
#include <gtest/gtest.h>

#include <set>

#include <nlohmann/json.hpp>

#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/scenario_checks.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "tests/nodes/scenario_fixture.hpp"

namespace furrow {
namespace {

using testing::kSmallest;
using testing::ScenarioFile;

/// The options as their structs default them; the schema must say the same.
TEST(Scenario, defaults_of_the_schema_are_those_of_the_options) {
  const scenario::Scenario s = testing::ScenarioFile(testing::kSmallest).load();
  const rigs::DrawbarRigOptions rig;
  EXPECT_EQ(s.rigs[0].mode, rig.mode);
  EXPECT_EQ(s.rigs[0].slip, rig.slip);
  EXPECT_EQ(s.rigs[0].angular_speed, rig.angular_speed);
  EXPECT_EQ(s.rigs[0].speed, rig.speed);
  EXPECT_EQ(s.rigs[0].ramp, rig.ramp);
  EXPECT_EQ(s.rigs[0].touchdown_damping, rig.touchdown_damping);
  EXPECT_EQ(s.rigs[0].touchdown_time, rig.touchdown_time);
  EXPECT_EQ(s.rigs[0].toe_angle, rig.toe_angle);
  EXPECT_EQ(s.rigs[0].travel_sign, rig.travel_sign);
  EXPECT_EQ(s.rigs[0].carrier_mass, rig.carrier_mass);
  EXPECT_EQ(s.rigs[0].chassis_mass, rig.chassis_mass);
  EXPECT_EQ(s.rigs[0].set_toe_mass, rig.set_toe_mass);
  EXPECT_EQ(s.rigs[0].rim_mass, rig.rim_mass);
  EXPECT_EQ(s.rigs[0].rim_spin_inertia, rig.rim_spin_inertia);
  EXPECT_EQ(s.rigs[0].rim_diametral_inertia, rig.rim_diametral_inertia);
  const terrain::TerrainOptions terrain;
  EXPECT_EQ(s.terrain.engine, terrain.engine);
  EXPECT_EQ(s.terrain.law, terrain.law);
  EXPECT_EQ(s.terrain.radius, terrain.radius);
  EXPECT_EQ(s.terrain.density, terrain.density);
  EXPECT_EQ(s.terrain.layers, terrain.layers);
  EXPECT_EQ(s.terrain.length, terrain.length);
  EXPECT_EQ(s.terrain.width, terrain.width);
  EXPECT_EQ(s.terrain.bed, terrain.bed);
  EXPECT_EQ(s.terrain.cache, terrain.cache);
  EXPECT_EQ(s.terrain.young_modulus, terrain.young_modulus);
  EXPECT_EQ(s.terrain.poisson_ratio, terrain.poisson_ratio);
  EXPECT_EQ(s.terrain.restitution, terrain.restitution);
  EXPECT_EQ(s.terrain.friction, terrain.friction);
  EXPECT_EQ(s.terrain.rolling_friction, terrain.rolling_friction);
  EXPECT_EQ(s.terrain.cohesion, terrain.cohesion);
  EXPECT_EQ(s.terrain.normal_stiffness, terrain.normal_stiffness);
  EXPECT_EQ(s.terrain.normal_damping, terrain.normal_damping);
  EXPECT_EQ(s.terrain.friction_velocity_scale, terrain.friction_velocity_scale);
  EXPECT_EQ(s.terrain.friction_impulse_limit, terrain.friction_impulse_limit);
  EXPECT_EQ(s.terrain.activity, terrain.activity);
  EXPECT_EQ(s.terrain.ground_stiffness, terrain.ground_stiffness);
  EXPECT_EQ(s.terrain.ground_damping, terrain.ground_damping);
  EXPECT_EQ(s.terrain.ground_shear_stiffness, terrain.ground_shear_stiffness);
  EXPECT_EQ(s.terrain.allow_unstable_step, terrain.allow_unstable_step);
  EXPECT_EQ(s.terrain.step, terrain.step);
  EXPECT_EQ(s.terrain.seed, terrain.seed);
  const tire::TireOptions tire;
  ASSERT_EQ(s.tires.size(), 1U);
  EXPECT_EQ(s.tires[0].pressure, tire.pressure);
  EXPECT_EQ(s.tires[0].friction, tire.friction);
  EXPECT_EQ(s.tires[0].elements_circumference, tire.elements_circumference);
  EXPECT_EQ(s.tires[0].elements_width, tire.elements_width);
  EXPECT_EQ(s.tires[0].structural_damping, tire.structural_damping);
  EXPECT_EQ(s.tires[0].rigid, tire.rigid);
  EXPECT_EQ(s.tires[0].contact_tangent, tire.contact_tangent);
  const scenario::RunOptions run;
  EXPECT_EQ(s.run.step, run.step);
  EXPECT_EQ(s.run.end, run.end);
  EXPECT_EQ(s.run.average_from, run.average_from);
  EXPECT_EQ(s.run.threads, run.threads);
  EXPECT_EQ(s.run.seed, run.seed);
  EXPECT_EQ(s.run.peer_timeout, run.peer_timeout);
  EXPECT_EQ(s.terrain.undisturbed_height, terrain.undisturbed_height);
  EXPECT_EQ(s.checkpoint.wall_interval, scenario::CheckpointOptions().wall_interval);
  EXPECT_EQ(s.checkpoint.interval, scenario::CheckpointOptions().interval);
  EXPECT_EQ(s.checkpoint.keep, scenario::CheckpointOptions().keep);
  EXPECT_EQ(s.checkpoint.at_end, scenario::CheckpointOptions().at_end);
  EXPECT_EQ(s.output.series_interval, scenario::OutputOptions().series_interval);
  EXPECT_EQ(s.output.frame_interval, scenario::OutputOptions().frame_interval);
  EXPECT_FALSE(s.expected.given);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(Scenario, a_setting_of_every_kind_arrives) {
  const scenario::Scenario s = testing::ScenarioFile(testing::kSmallest)
                                   .load({{"rig.slip", "0.5"},
                                          {"rig.mode", "fixed_speed"},
                                          {"tire.rigid", "true"},
                                          {"tire.elements_width", "12"},
                                          {"terrain.substeps", "2"},
                                          {"tire.substeps", "4"},
                                          {"run.threads", "3"},
                                          {"run.seed", "7"}});
  EXPECT_EQ(s.rigs[0].slip, 0.5);
  EXPECT_EQ(s.rigs[0].mode, "fixed_speed");
  EXPECT_TRUE(s.tires[0].rigid);
  EXPECT_EQ(s.tires[0].elements_width, 12);
  EXPECT_EQ(s.terrain.step, 2e-5);
  EXPECT_EQ(s.tires[0].substep, 1e-5);
  EXPECT_EQ(s.run.threads, 3);
  EXPECT_EQ(s.terrain.seed, 7U);
}

TEST(Scenario, completed_text_is_a_scenario_that_gives_the_same_digest) {
  const scenario::Scenario s = testing::ScenarioFile(testing::kSmallest).load({{"rig.slip", "0.2"}});
  const scenario::Scenario again = testing::ScenarioFile(s.completed).load();
  EXPECT_EQ(again.digest, s.digest);
  EXPECT_EQ(again.completed, s.completed);
}

TEST(Scenario, digest_depends_on_what_decides_the_results_alone) {
  const testing::ScenarioFile file(testing::kSmallest);
  const std::string digest = file.load().digest;
  EXPECT_EQ(file.load({{"run.threads", "2"}}).digest, digest);
  EXPECT_EQ(file.load({{"run.peer_timeout", "5"}}).digest, digest);
  EXPECT_EQ(file.load({{"terrain.cache", "false"}}).digest, digest);
  EXPECT_EQ(file.load({{"rig.carrier_mass", "450.0"}, {"terrain.layers", "15.0"}}).digest, digest);
  EXPECT_NE(file.load({{"rig.carrier_mass", "451"}}).digest, digest);
  EXPECT_NE(file.load({{"run.seed", "2"}}).digest, digest);
}

TEST(Scenario, axle_starts_clear_of_the_wall_behind_it) {
  const testing::ScenarioFile file(testing::kSmallest);
  const double radius = 0.4673;  // m, of the tire
  const scenario::Scenario forward = file.load(), backward = file.load({{"rig.travel_sign", "-1"}});
  EXPECT_DOUBLE_EQ(forward.rigs[0].start, radius + scenario::kWallMargin);
  EXPECT_DOUBLE_EQ(backward.rigs[0].start, 10.0 - radius - scenario::kWallMargin);
  EXPECT_DOUBLE_EQ(file.load({{"rig.start", "3"}}).rigs[0].start, 3.0);
  // v = ω R (1 − s) over the run, half of it over the ramp.
  const scenario::AxlePath path = scenario::axle_path(forward, 0, radius);
  EXPECT_NEAR(path.to - path.from, 8.56 * radius * 0.7 * (1.5 - 0.075), 1e-12);
  EXPECT_NEAR(scenario::axle_path(backward, 0, radius).to - backward.rigs[0].start, -(path.to - path.from),
              1e-12);
}

TEST(Scenario, expected_result_is_void_once_the_physics_is_changed) {
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {},
                              "expected": {"drawbar_pull": 1500, "drawbar_pull_spread": 100}})");
  EXPECT_TRUE(file.load().expected.given);
  EXPECT_TRUE(file.load({{"run.threads", "2"}, {"output.frame_interval", "0"}}).expected.given);
  EXPECT_FALSE(file.load({{"rig.slip", "0.2"}}).expected.given);
}

TEST(Scenario, soil_file_gives_values_that_the_scenario_may_replace) {
  const testing::ScenarioFile soil(
      R"({"format_version": 1, "terrain": {"friction": 0.4, "size_spread": 0.2}})");
  const std::string name = soil.path().string();
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"},
                              "terrain": {"material": ")" +
                                   name + R"(", "friction": 0.7}})");
  const scenario::Scenario s = file.load();
  EXPECT_EQ(s.terrain.friction, 0.7);
  EXPECT_EQ(s.terrain.size_spread, 0.2);
  EXPECT_EQ(testing::ScenarioFile(s.completed).load().digest, s.digest);
  // On the command line what comes later wins.
  const std::string quoted = '"' + name + '"';
  const testing::ScenarioFile own(
      R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"friction": 0.7}})");
  EXPECT_EQ(own.load({{"terrain.material", quoted}}).terrain.friction, 0.4);
  EXPECT_EQ(own.load({{"terrain.material", quoted}, {"terrain.friction", "0.6"}}).terrain.friction, 0.6);
  EXPECT_EQ(file.load({{"terrain.material", "null"}}).terrain.size_spread, 0.0);
}

TEST(Scenario, mistakes_in_a_soil_file_are_named_with_that_file) {
  const auto complaint = [](const std::string& text) {
    const testing::ScenarioFile soil(text), own(testing::kSmallest);
    return own.complaint({{"terrain.material", '"' + soil.path().string() + '"'}}, soil.path());
  };
  EXPECT_EQ(complaint(R"({"format_version": 1, "terrain": {"friction": -1}})"),
            ": key 'terrain.friction': is -1, expected a number, 0 to 10");
  EXPECT_EQ(complaint(R"({"format_version": 1, "terrain": {"radius": 0.01}})").substr(0, 62),
            ": key 'terrain.radius': is not a property of soil, expected on");
  EXPECT_EQ(complaint(R"({"format_version": 2, "terrain": {}})"),
            ": key 'format_version': is 2: the file is newer than this program, expected at most 1");
  EXPECT_EQ(complaint(R"({"format_version": 1})"), ": key 'terrain': is missing, expected an object { }");
}

TEST(Scenario, mistakes_are_named_with_what_is_expected) {
  const testing::ScenarioFile file(testing::kSmallest);
  EXPECT_EQ(file.complaint({{"rig.slipp", "1"}}), ": key 'rig.slipp': is unknown, expected 'rig.slip'?");
  EXPECT_EQ(file.complaint({{"tire.elements_width", "7"}}),
            ": key 'tire.elements_width': is 7, expected a whole number, 6 to 1000, a multiple of 2 or null");
  EXPECT_EQ(file.complaint({{"terrain.layers", "many"}}),
            ": key 'terrain.layers': is 'many', expected a whole number, 1 to 9999");
  EXPECT_EQ(file.complaint({{"tire.rigid", "true"}, {"tire.contact_tangent", "true"}}),
            ": key 'tire.contact_tangent': is true, expected false for a rigid tire");
  EXPECT_TRUE(file.load({{"tire.contact_tangent", "true"}}).terrain.contact_tangents);
  EXPECT_EQ(file.complaint({{"run.step", "1e-3"}}).substr(0, 66),
            ": key 'run.step': 0.001 s is above the stable step of 6.35e-05 s (");
  EXPECT_EQ(file.complaint({{"run.step", "1e-3"},
                            {"output.series_interval", "1e-3"},
                            {"terrain.allow_unstable_step", "true"}}),
            "");
}

TEST(Scenario, pressure_is_a_number_or_a_table_in_time_and_part_of_the_digest) {
  const testing::ScenarioFile file(testing::kSmallest);
  const scenario::Scenario constant = file.load({{"tire.pressure", "150e3"}}),
                           table = file.load({{"tire.pressure", "[[0.5, 2e5], [1, 1e5]]"}}),
                           other = file.load({{"tire.pressure", "[[0.5, 2e5], [1.5, 1e5]]"}});
  EXPECT_EQ(constant.tires[0].pressure, (tire::PressureSchedule{{{0.0, 150e3}}}));
  EXPECT_EQ(table.tires[0].pressure, (tire::PressureSchedule{{{0.5, 2e5}, {1.0, 1e5}}}));
  EXPECT_NE(table.digest, other.digest);
  EXPECT_FALSE(scenario::may_change_on_resume("tire.pressure.1.0"));
}

TEST(Scenario, magnitudes_of_another_unit_are_warned_of) {
  const testing::ScenarioFile file(testing::kSmallest);
  const auto warnings =
      file.load({{"tire.pressure", "2"}, {"terrain.density", "2.5"}, {"terrain.substeps", "100"}}).warnings;
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("key 'terrain.density': 2.5 kg/m³ is unusually small"), std::string::npos)
      << warnings[0];
  EXPECT_NE(warnings[0].find("did you mean 2500?"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("did you mean 200e3?"), std::string::npos) << warnings[1];
  EXPECT_TRUE(file.load({{"tire.pressure", "0"}, {"terrain.cohesion", "0"}}).warnings.empty());
}

TEST(Schema, every_key_of_the_defaults_is_found_and_no_other) {
  const scenario::Schema schema = scenario::Schema::load();
  std::set<std::string> unique;
  for (const std::string& key : schema.keys()) {
    EXPECT_NE(schema.find(key), nullptr) << key;
    EXPECT_TRUE(unique.insert(key).second) << key;
  }
  EXPECT_NE(schema.find("tires.3.pressure"), nullptr);
  EXPECT_EQ(schema.find("tires.pressure"), nullptr);
  EXPECT_EQ(schema.find("rig.slip.x"), nullptr);
  EXPECT_EQ(schema.find(""), nullptr);
}

TEST(Schema, defaults_obey_the_schema) {
  nlohmann::json document = nlohmann::json::parse(testing::kSmallest);
  const scenario::Schema schema = scenario::Schema::load();
  schema.fill_defaults(document);
  schema.normalize(document);
  EXPECT_TRUE(schema.problems(document).empty());
  EXPECT_TRUE(schema.unusual(document).empty());
}

}  // namespace
}  // namespace furrow
