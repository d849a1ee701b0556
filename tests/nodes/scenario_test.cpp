// Loading of scenarios: defaults from the schema, settings, digests, starting places.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/scenario/estimate.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/scenario_checks.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/validate.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "nodes/scenario/wheel_scales.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "terrain/dem/dem_options.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using testing::kSmallest;
using testing::ScenarioFile;

/// The smallest scenario with settings.
class Smallest : public ::testing::Test {
 protected:
  const ScenarioFile file_{kSmallest};
};

/// The defaults of the options' structs must equal the schema's. Those of rig, tire and run are tested in
/// scenario_fields_test.cpp.
TEST(Scenario, defaults_of_the_schema_are_those_of_the_options) {
  const scenario::Scenario s = testing::ScenarioFile(testing::kSmallest).load();
  EXPECT_EQ(s.terrain_context().step, terrain::TerrainContext().step);
  EXPECT_EQ(s.terrain_context().seed, terrain::TerrainContext().seed);
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
  const rigs::RigDescription rig = scenario::describe_rig(s);
  EXPECT_EQ(rig.wheels.front().slip, 0.5);
  EXPECT_EQ(rig.text, "1 drawbar rig, fixed_speed");
  ASSERT_EQ(s.tires.size(), 1U);
  EXPECT_TRUE(s.tires[0]->options().rigid);
  EXPECT_EQ(s.tires[0]->options().elements_width, 12);
  EXPECT_EQ(s.terrain_context().step, 2e-5);
  EXPECT_EQ(s.tire_substeps, 4);
  EXPECT_EQ(s.run.threads, 3);
  EXPECT_EQ(s.terrain_context().seed, 7U);
}

TEST_F(Smallest, numbers_that_no_arithmetic_can_bear_are_refused) {
  for (const auto& [key, value] : {std::pair{"terrain.young_modulus", "5e-324"},
                                   {"terrain.density", "1e-300"},
                                   {"terrain.radius", "5e-324"},
                                   {"terrain.normal_stiffness", "1e-300"},
                                   {"tire.elements_width", "-1e308"},
                                   {"tire.elements_width", "1e308"}})
    EXPECT_TRUE(holds(file_.complaint({{key, value}}), key)) << key << ' ' << value;
}

TEST(Scenario, a_line_of_the_series_may_be_as_long_as_the_averaging_window) {
  const ScenarioFile file(kSmallest);  // 0.3 − 0.2 < 0.1 in binary
  EXPECT_EQ(file.complaint({{"run.end", "0.3"}, {"run.average_from", "0.2"}, {"output.series_interval", "0.1"}}), "");
  EXPECT_TRUE(
      holds(file.complaint({{"run.end", "0.3"}, {"run.average_from", "0.22"}, {"output.series_interval", "0.1"}}),
            "output.series_interval"));
}

TEST(Scenario, completed_text_is_a_scenario_that_gives_the_same_digest) {
  const scenario::Scenario s = testing::ScenarioFile(testing::kSmallest).load({{"rig.slip", "0.2"}});
  const scenario::Scenario again = testing::ScenarioFile(s.completed).load();
  EXPECT_EQ(again.digest, s.digest);
  EXPECT_EQ(again.completed, s.completed);
}

/// A tire whose file has its own friction ignores the ground's default friction; a stated friction applies, and is
/// kept.
TEST(Scenario, friction_of_the_ground_counts_for_a_handling_tire_where_it_is_stated) {
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_handling.json"}, "terrain": {"engine": "rigid"}})");
  const scenario::Scenario open = file.load(), stated = file.load({{"terrain.friction", "0.9"}});
  EXPECT_FALSE(open.ground_friction);
  EXPECT_EQ(stated.ground_friction, 0.9);
  EXPECT_NE(open.digest, stated.digest);
  for (const scenario::Scenario& s : {open, stated}) {
    const scenario::Scenario again = testing::ScenarioFile(s.completed).load();
    EXPECT_EQ(again.ground_friction, s.ground_friction);
    EXPECT_EQ(again.digest, s.digest);
    EXPECT_EQ(again.completed, s.completed);
  }
}

TEST_F(Smallest, axle_starts_clear_of_the_wall_behind_it) {
  const double radius = 0.4673;  // m, of the tire
  const scenario::Scenario forward = file_.load(), backward = file_.load({{"rig.travel_sign", "-1"}});
  const auto wheel = [](const scenario::Scenario& s) { return scenario::describe_rig(s).wheels.front(); };
  EXPECT_DOUBLE_EQ(wheel(forward).from, radius + scenario::wall_margin(radius));
  EXPECT_DOUBLE_EQ(wheel(backward).from, 10.0 - radius - scenario::wall_margin(radius));
  EXPECT_EQ(scenario::wall_margin(radius), 0.02);
  EXPECT_DOUBLE_EQ(scenario::wall_margin(0.058), 0.0029);
  EXPECT_DOUBLE_EQ(wheel(file_.load({{"rig.start", "3"}})).from, 3.0);
  // v = ω R (1 − s) over the run, half of it over the ramp.
  const double travel = wheel(forward).to - wheel(forward).from;
  EXPECT_NEAR(travel, 8.56 * radius * 0.7 * (1.5 - 0.075), 1e-12);
  EXPECT_NEAR(wheel(backward).to - wheel(backward).from, -travel, 1e-12);
}

TEST_F(Smallest, a_load_in_newtons_is_the_load_of_the_wheel_and_stays_the_way_it_was_said) {
  const scenario::Scenario s = file_.load({{"rig.load", "5000"}});
  EXPECT_NEAR(scenario::wheel_scales(s).front().load, 5000.0, 1e-9);
  const nlohmann::json rig = nlohmann::json::parse(s.completed)["rig"];
  EXPECT_EQ(rig["load"], 5000.0);
  EXPECT_TRUE(rig["carrier_mass"].is_null());
  EXPECT_EQ(rig["rim_mass"], 15.0);
  const scenario::Scenario again = testing::ScenarioFile(s.completed).load();
  EXPECT_EQ(again.digest, s.digest);
  EXPECT_EQ(again.completed, s.completed);
  EXPECT_EQ(file_.complaint({{"rig.load", "5000"}, {"rig.carrier_mass", "450"}}),
            ": key 'rig.load': is given beside 'rig.carrier_mass', expected one of the two");
}

/// Regression: every wheel got a rim of 15 kg and a carrier of 450 kg.
TEST(Scenario, a_tire_file_without_a_rim_leaves_the_masses_to_the_scenario) {
  nlohmann::json tire = load_json(data_folder() / "tire" / "data" / "hmmwv_layered.json", "a tire");
  tire.erase("rim");
  const testing::ScenarioFile bare(tire.dump());
  const testing::ScenarioFile file(R"({"tire": {"file": ")" + bare.path().string() + R"("}, "terrain": {}})");
  const std::string told = file.complaint();
  for (const char* word : {"'rig.load'", "rig.carrier_mass", "rig.rim_mass", "rig.rim_spin_inertia", "'rim'"})
    EXPECT_TRUE(holds(told, word));
  EXPECT_EQ(file.complaint({{"rig.load", "4600"}, {"rig.rim_mass", "12"}, {"rig.rim_spin_inertia", "0.5"}}), "");
  tire["rim"] = {{"mass", 12}, {"weight", 3}};
  const testing::ScenarioFile wrong(tire.dump());
  const testing::ScenarioFile other(R"({"tire": {"file": ")" + wrong.path().string() + R"("}, "terrain": {}})");
  EXPECT_TRUE(holds(other.complaint({}, wrong.path()), "key 'rim.weight': is unknown"));
}

std::set<std::string> bounding_keys(const scenario::Scenario& s) {
  std::set<std::string> keys;
  for (const scenario::Bound& bound : scenario::scale_bounds(s)) keys.insert(bound.key);
  return keys;
}

/// hmmwv_handling.tir was fitted up to 6.6 kN.
TEST(Scenario, a_load_far_beyond_what_the_tire_was_fitted_to_is_warned_of) {
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_handling.json"}, "terrain": {"engine": "rigid"}})");
  const auto told = [&](const char* load) {
    return fmt::format("{}", fmt::join(file.load({{"rig.load", load}}).warnings, "\n"));
  };
  EXPECT_FALSE(holds(told("9000"), "fitted up to"));
  EXPECT_TRUE(holds(told("12000"), "key 'tire.file': carries 12000 N, but was fitted up to 6633 N")) << told("12000");
}

/// The spin of a wheel on its grip, and the bounce of a light one on empirical soil.
TEST(Scenario, a_step_that_is_too_large_for_a_wheel_on_its_spring_is_warned_of) {
  const testing::ScenarioFile grip(R"({"tire": {"file": "hmmwv_handling.json"}, "terrain": {"engine": "rigid"}})");
  const testing::ScenarioFile bounce(R"({"rig": {"load": 20, "rim_mass": 0.3, "rim_spin_inertia": 0.001},
      "tire": {"file": "rigid_drum.json", "rigid": true},
      "terrain": {"engine": "scm", "material": "lete_sand.json"}})");
  for (const auto& [file, what] : {std::pair{&grip, "the spin of its wheel on the tire's grip"},
                                   {&bounce, "the bounce of its wheel on the ground's stiffness"}}) {
    const auto told = [&](const char* step) {
      return fmt::format("{}", fmt::join(file->load({{"run.step", step}}).warnings, "\n"));
    };
    EXPECT_FALSE(holds(told("1e-5"), "allows: the timing"));
    EXPECT_TRUE(holds(told("1e-2"), std::string("s that ") + what + " allows: the timing of contact forces"))
        << told("1e-2");
  }
}

TEST(Scales, what_binds_the_wheel_of_a_laboratory_is_named_by_its_key) {
  const auto load = [](const std::vector<std::pair<std::string, std::string>>& settings) {
    return scenario::load_scenario(data_folder() / "rigs" / "small_wheel.json", settings);
  };
  using Keys = std::set<std::string>;
  EXPECT_EQ(bounding_keys(load({})), Keys{});
  EXPECT_EQ(bounding_keys(load({{"terrain.radius", "0.006"}, {"terrain.layers", "50"}})), Keys{"terrain.radius"});
  EXPECT_EQ(bounding_keys(load({{"terrain.layers", "40"}})), Keys{"terrain.layers"});
  EXPECT_EQ(bounding_keys(load({{"terrain.width", "0.08"}, {"terrain.layers", "90"}})), Keys{"terrain.width"});
  EXPECT_EQ(bounding_keys(load({{"terrain.width", "0.08"}, {"terrain.layers", "90"}, {"terrain.sides", "periodic"}})),
            Keys{});
  EXPECT_EQ(bounding_keys(load({{"terrain.length", "0.28"}})), Keys{"terrain.length"});
  EXPECT_EQ(bounding_keys(load({{"rig.lowering_speed", "0.01"}})), Keys{"rig.move_from"});
  const Keys fast = bounding_keys(load({{"rig.angular_speed", "35"}, {"terrain.length", "4"}}));
  EXPECT_TRUE(fast.count("rig.slip") == 1 && fast.count("rig.speed") == 1);
}

TEST(Scales, sinkage_by_bearing_capacity_is_near_that_of_the_runs) {
  const auto sinkage = [](const char* cohesion, const char* carrier) {
    const scenario::Scenario s = scenario::load_scenario(
        data_folder() / "rigs" / "drawbar_pull_small_report_soil.json",
        {{"terrain.cohesion", cohesion}, {"rig.carrier_mass", carrier}, {"terrain.cone_index", "null"}});
    return scenario::wheel_scales(s).front().grains->sinkage;
  };
  // At slip 0.3: 20, 35 and, on a deep bed, 77 mm (tests/studies/slip_passes.md); 33 mm with twice the load (f06f6f2).
  EXPECT_NEAR(sinkage("80e3", "450") / 0.020, 1.0, 0.4);
  EXPECT_NEAR(sinkage("40e3", "450") / 0.035, 1.0, 0.4);
  EXPECT_NEAR(sinkage("20e3", "450") / 0.077, 1.0, 0.4);
  EXPECT_NEAR(sinkage("80e3", "900") / 0.033, 1.0, 0.6);
}

/// Runs at slip 0.1, 0.3, 0.5 and 0.7 sank by 4, 14, 28 and 48 mm (tests/studies/lete_sand_slip.csv).
/// By hand, with d = 0.9346 m and the tire's width: √(z/d) = 1/B_n + s/(2 √B_n).
TEST(Scales, sinkage_by_cone_index_is_that_of_brixius_and_near_that_of_the_runs) {
  const auto sinkage = [](const char* slip, const char* index = "340e3", const char* cohesion = "7444") {
    const scenario::Scenario s =
        scenario::load_scenario(data_folder() / "rigs" / "drawbar_pull_small.json",
                                {{"rig.slip", slip}, {"terrain.cone_index", index}, {"terrain.cohesion", cohesion}});
    const scenario::WheelScales w = scenario::wheel_scales(s).front();
    const double d = 0.9346, b = s.tires[0]->describe().width, soft = std::sqrt(w.grains->sinkage / d),
                 number = std::stod(index) * b * d / w.load / (1.0 + 3.0 * b / d);
    if (w.grains->by_cone_index) {
      EXPECT_NEAR(soft, 1.0 / number + 0.5 * std::stod(slip) / std::sqrt(number), 1e-6);
    }
    return w.grains->sinkage;
  };
  EXPECT_NEAR(sinkage("0.3") / 0.0147, 1.0, 0.3);
  EXPECT_NEAR(sinkage("0.5") / 0.028, 1.0, 0.3);
  EXPECT_NEAR(sinkage("0.7") / 0.048, 1.0, 0.4);
  EXPECT_NEAR(sinkage("0.3", "170e3") / sinkage("0.3"), 3.0, 0.3);
  EXPECT_EQ(sinkage("0.3", "340e3", "80e3"), sinkage("0.3", "170e3", "80e3"));  // of cohesive soil it is not used
}

TEST(Scales, bed_is_compared_with_the_depth_that_grousers_reach) {
  const auto of = [](const char* grousers, const char* height) {
    return *scenario::wheel_scales(
                scenario::load_scenario(
                    data_folder() / "rigs" / "small_wheel.json",
                    {{"tire.grousers", grousers}, {"tire.grouser_height", height}, {"tire.grouser_thickness", height}}))
                .front()
                .grains;
  };
  const auto smooth = of("0", "null"), lugged = of("12", "0.01");
  EXPECT_EQ(lugged.sinkage, smooth.sinkage);
  EXPECT_NEAR(lugged.depth_ratio * (smooth.sinkage + 0.01), smooth.depth_ratio * smooth.sinkage, 1e-12);
}

TEST(Scales, a_report_for_programs_holds_them_for_each_wheel) {
  const auto report =
      scenario::validation_report(scenario::load_scenario(data_folder() / "rigs" / "four_wheels.json", {}));
  ASSERT_EQ(report["wheels"].size(), 4U);
  for (const char* key :
       {"load_N", "contact_pressure_Pa", "width_in_grains", "contact_length_in_grains", "expected_sinkage_m",
        "sinkage_by", "bed_height_over_sinkage", "beside_m", "ahead_at_end_m", "froude_number", "inertial_number"})
    EXPECT_TRUE(report["wheels"][3].contains(key)) << key;
  EXPECT_NEAR(report["wheels"][3]["load_N"].get<double>() - report["wheels"][0]["load_N"].get<double>(), 500.0 * 9.81,
              1e-9);
  EXPECT_TRUE(report["bound_by"].is_array());
}

TEST(Scenario, expected_result_is_void_once_the_physics_is_changed) {
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {},
                              "expected": {"drawbar_pull": 1500, "drawbar_pull_spread": 100}})");
  EXPECT_TRUE(file.load().expected.given);
  EXPECT_TRUE(file.load({{"run.threads", "2"}, {"output.frame_interval", "0"}}).expected.given);
  EXPECT_FALSE(file.load({{"rig.slip", "0.2"}}).expected.given);
}

TEST(Scenario, only_grains_take_threads) {
  const testing::ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {}})");
  EXPECT_EQ(file.load({{"run.threads", "3"}}).run.threads, 3);
  for (const std::string engine : {"scm", "rigid"})
    EXPECT_EQ(file.load({{"run.threads", "3"}, {"run.step", "1e-4"}, {"terrain.engine", engine}}).run.threads, 1)
        << engine;
}

TEST_F(Smallest, a_speed_in_the_mode_of_an_imposed_spin_is_warned_of) {
  const auto told = [&](const char* mode, const char* speed) {
    const std::string quoted = '"' + std::string(mode) + '"';
    return fmt::format("{}", fmt::join(file_.load({{"rig.mode", quoted}, {"rig.speed", speed}}).warnings, "\n"));
  };
  EXPECT_TRUE(holds(told("fixed_angular_speed", "3"), "'rig.speed': is 3 m/s and is not used"));
  EXPECT_FALSE(holds(told("fixed_speed", "3"), "not used"));
}

TEST_F(Smallest, mistakes_are_named_with_what_is_expected) {
  EXPECT_EQ(file_.complaint({{"rig.slipp", "1"}}), ": key 'rig.slipp': is unknown, expected 'rig.slip'?");
  EXPECT_EQ(file_.complaint({{"tire.elements_width", "7"}}),
            ": key 'tire.elements_width': is 7, expected a whole number, 6 to 1000, a multiple of 2 or null");
  EXPECT_EQ(file_.complaint({{"terrain.layers", "many"}}),
            ": key 'terrain.layers': is 'many', expected a whole number, 1 to 9999");
  EXPECT_EQ(file_.complaint({{"tire.rigid", "true"}, {"tire.contact_tangent", "true"}}),
            ": key 'tire.contact_tangent': is true, expected false for a rigid tire");
  EXPECT_TRUE(file_.load({{"tire.contact_tangent", "true"}}).terrain_context().contact_tangents);
  EXPECT_EQ(file_.complaint({{"run.step", "1e-3"}}).substr(0, 66),
            ": key 'run.step': 0.001 s is above the stable step of 6.35e-05 s (");
  EXPECT_NO_THROW(file_.load({{"run.step", "1e-3"}}, scenario::Purpose::soil_tests));
  EXPECT_EQ(file_.complaint(
                {{"run.step", "1e-3"}, {"output.series_interval", "1e-3"}, {"terrain.allow_unstable_step", "true"}}),
            "");
}

TEST_F(Smallest, pressure_is_a_number_or_a_table_in_time_and_part_of_the_digest) {
  const scenario::Scenario constant = file_.load({{"tire.pressure", "150e3"}}),
                           table = file_.load({{"tire.pressure", "[[0.5, 2e5], [1, 1e5]]"}}),
                           other = file_.load({{"tire.pressure", "[[0.5, 2e5], [1.5, 1e5]]"}});
  EXPECT_EQ(constant.tires[0]->options().pressure, (tire::PressureSchedule{{{0.0, 150e3}}}));
  EXPECT_EQ(table.tires[0]->options().pressure, (tire::PressureSchedule{{{0.5, 2e5}, {1.0, 1e5}}}));
  EXPECT_NE(table.digest, other.digest);
}

TEST_F(Smallest, magnitudes_of_another_unit_are_warned_of) {
  const auto warnings =
      file_.load({{"tire.pressure", "2"}, {"terrain.density", "2.5"}, {"terrain.substeps", "100"}}).warnings;
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(holds(warnings[0], "key 'terrain.density': 2.5 kg/m³ is unusually small"));
  EXPECT_TRUE(holds(warnings[0], "did you mean 2500 (g/cm³)?"));
  EXPECT_TRUE(holds(warnings[1], "did you mean 200e3 (bar) or 13790 (psi) or 2e6 (MPa)?"));
  EXPECT_TRUE(file_.load({{"tire.pressure", "0"}, {"terrain.cohesion", "0"}}).warnings.empty());
}

TEST_F(Smallest, masses_of_a_rim_in_another_unit_are_warned_of) {
  nlohmann::json tire = nlohmann::json::parse(std::ifstream(data_folder() / "tire" / "data" / "hmmwv_layered.json"));
  tire["rim"]["mass"] = 15000;         // g
  tire["rim"]["carrier_mass"] = 0.05;  // of a ton
  std::ofstream(file_.path().parent_path() / "mine.json") << tire.dump();
  const auto told = fmt::format("{}", fmt::join(file_.load({{"tire.file", "mine.json"}}).warnings, "\n"));
  EXPECT_TRUE(holds(told, "mine.json: key 'rim.mass': 15e3 kg is unusually large")) << told;
  EXPECT_TRUE(holds(told, "mine.json: key 'rim.carrier_mass': 0.05 kg is unusually small")) << told;
}

/// Of a .tir, whose comments may be in any encoding.
TEST(Scenario, a_tire_property_file_with_a_comment_in_latin_1_is_read) {
  const testing::ScenarioFile file(
      R"({"rig": {"load": 4000, "rim_mass": 15, "rim_spin_inertia": 0.7}, "tire": {"file": "mine.tir"},
          "terrain": {"engine": "rigid"}})");
  std::ofstream(file.path().parent_path() / "mine.tir", std::ios::binary)
      << "$ Gr\xf6\xdf"
         "e\n"
      << std::ifstream(data_folder() / "tire" / "data" / "hmmwv_handling.tir", std::ios::binary).rdbuf();
  EXPECT_EQ(file.load().file_hashes().size(), 1U);
}

TEST_F(Smallest, times_that_are_no_whole_steps_are_told) {
  const auto warnings = [&](const char* key, const char* value) { return file_.load({{key, value}}).warnings; };
  const auto only = [&](const char* key, const char* value, const std::string& expected) {
    const auto told = warnings(key, value);
    ASSERT_EQ(told.size(), 1U) << key;
    EXPECT_TRUE(holds(told[0], std::string("key '") + key + "': " + expected));
  };
  only("output.series_interval", "3.3e-4", "is 0.00033 s, not a whole number of steps of 4e-5 s: 0.00032 s is used");
  only("output.series_interval", "1e-9", "is 1e-9 s, not a whole number of steps of 4e-5 s: 4e-5 s is used");
  only("output.frame_interval", "0.03001", "is 0.03001 s, not a whole number of steps of 4e-5 s: 0.03 s is used");
  only("checkpoint.interval", "0.10001", "is 0.10001 s, not a whole number of steps of 4e-5 s: 0.1 s is used");
  only("run.end", "1.50003", "is 1.50003 s, not a whole number of steps of 4e-5 s: 1.50004 s is used");
  EXPECT_TRUE(warnings("output.series_interval", "0.0012").empty());
  EXPECT_TRUE(warnings("output.frame_interval", "0").empty());
  EXPECT_TRUE(warnings("run.end", "1.50004").empty());
}

TEST_F(Smallest, disk_is_estimated_with_at_most_one_frame_and_one_line_per_step) {
  const auto disk = [&](const char* key, const char* value) {
    return scenario::estimate(file_.load({{key, value}})).disk;
  };
  for (const char* key : {"output.frame_interval", "output.series_interval"}) {
    EXPECT_EQ(disk(key, "1e-12"), disk(key, "4e-5")) << key;
    EXPECT_GT(disk(key, "4e-5"), disk(key, "8e-5")) << key;
  }
}

TEST(Scenario, a_tire_that_damps_nothing_is_warned_of_with_a_damping_that_would_do) {
  const auto warnings = testing::ScenarioFile(testing::kSmallest).load({{"tire.structural_damping", "0"}}).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(holds(warnings[0], "key 'tire.structural_damping': is 0 s: contact forces come one step late"));
  EXPECT_TRUE(holds(warnings[0], "expected at least 0.002 s for a run.step of 4e-5 s"));
}

TEST(Scenario, wheels_that_share_a_tire_warn_of_it_once) {
  const auto warnings =
      testing::ScenarioFile(testing::kSmallest)
          .load({{"rig.wheels", R"([{"start": 1}, {"start": 3}, {"start": 5}])"}, {"tire.structural_damping", "1e-4"}})
          .warnings;
  ASSERT_EQ(warnings.size(), 1U);
}

TEST(Scenario, a_shipped_one_is_found_by_its_bare_name) {
  const scenario::Scenario s = scenario::load_scenario("first_look.json", {});
  EXPECT_EQ(s.name, "first_look");
  EXPECT_EQ(s.file.filename(), "first_look.json");
  EXPECT_THROW(scenario::load_scenario("./first_look.json", {}), Error);
  EXPECT_THROW(scenario::load_scenario("no_such_scenario.json", {}), Error);
}

TEST_F(Smallest, settings_cannot_nest_without_end) {
  std::string key = "a";
  for (int k = 0; k < 200000; ++k) key += ".a";
  EXPECT_TRUE(holds(file_.complaint({{key, "1"}}), "': is not a key, expected --set section.key=value"));
  EXPECT_LT(file_.complaint({{key, "1"}}).size(), 200U);
  EXPECT_TRUE(holds(file_.complaint({{"rig.slip\n", "1"}}), "key 'rig.slip\\n': is not a key"));
  EXPECT_TRUE(holds(file_.complaint({{"tire.pressure", std::string(100000, '[') + std::string(100000, ']')}}),
                    "nested deeper"));
}

TEST(Scenario, names_of_files_are_single_lines) {
  for (const std::string& name :
       {std::string("hmmwv_layered.json\0x", 20), std::string("a\nb"), std::string(5000, 'x')}) {
    const std::string told =
        testing::ScenarioFile(testing::kSmallest).complaint({{"tire.file", nlohmann::json(name).dump()}});
    EXPECT_TRUE(holds(told, "key 'tire.file': is '"));
    EXPECT_TRUE(holds(told, "expected the name of a file"));
    EXPECT_LT(told.size(), 300U);
  }
}

TEST(Scenario, of_very_many_mistakes_the_first_are_told) {
  nlohmann::json document = nlohmann::json::parse(testing::kSmallest);
  for (int k = 0; k < 9000; ++k) document["terrain"]["unknown" + std::to_string(k)] = k;
  const std::string told = testing::ScenarioFile(document.dump()).complaint();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 20);
  EXPECT_TRUE(holds(told, "these are the first 20 mistakes, there are more"));
}

TEST(Schema, every_key_of_the_defaults_is_found_and_no_other) {
  const scenario::Schema& schema = scenario::Schema::of_scenarios();
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
  const scenario::Schema& schema = scenario::Schema::of_scenarios();
  schema.fill_defaults(document);
  schema.normalize(document);
  EXPECT_TRUE(schema.problems(document).empty());
  EXPECT_TRUE(schema.unusual(document).empty());
}

}  // namespace
}  // namespace furrow
