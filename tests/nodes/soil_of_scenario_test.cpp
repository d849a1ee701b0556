// The soil of a scenario: files of soils, what of them a setting replaces, and what is warned of.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "terrain/dem/dem_options.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using testing::kSmallest;
using testing::ScenarioFile;

TEST(SoilOfScenario, soil_file_gives_values_that_the_scenario_may_replace) {
  const ScenarioFile soil(R"({"format_version": 1, "terrain": {"friction": 0.4, "size_spread": 0.2}})");
  const std::string name = soil.path().string();
  const ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"},
                              "terrain": {"material": ")" +
                          name + R"(", "friction": 0.7}})");
  const scenario::Scenario s = file.load();
  EXPECT_EQ(s.terrain->grains()->friction, 0.7);
  EXPECT_EQ(s.terrain->grains()->size_spread, 0.2);
  EXPECT_EQ(ScenarioFile(s.completed).load().digest, s.digest);
  // On the command line the later setting applies.
  const std::string quoted = '"' + name + '"';
  const ScenarioFile own(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"friction": 0.7}})");
  EXPECT_EQ(own.load({{"terrain.material", quoted}}).terrain->grains()->friction, 0.4);
  EXPECT_EQ(own.load({{"terrain.material", quoted}, {"terrain.friction", "0.6"}}).terrain->grains()->friction, 0.6);
  EXPECT_EQ(file.load({{"terrain.material", "null"}}).terrain->grains()->size_spread, 0.0);
}

TEST(SoilOfScenario, a_cohesive_soil_taken_as_it_is_with_grains_of_another_size_is_warned_of) {
  const auto warnings = [](const std::string& cohesion, const std::string& measured, const std::string& more) {
    const ScenarioFile soil(R"({"format_version": 1, "terrain": {"friction": 0.4, "cohesion": )" + cohesion +
                            R"(}, "measured": )" + measured + "}");
    return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"material": ")" + soil.path().string() +
                        R"(", "radius": 0.006)" + more + "}}")
        .load()
        .warnings;
  };
  const std::vector<std::string> told = warnings("30e3", R"({"grain_radius_m": 0.01})", "");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(holds(told[0], "key 'terrain.radius': is 0.006 m, but the strength of"));
  EXPECT_TRUE(warnings("30e3", R"({"grain_radius_m": 0.006})", "").empty());
  EXPECT_TRUE(warnings("30e3", R"({"grain_radius_m": "ten"})", "").empty());
  EXPECT_TRUE(warnings("30e3", "{}", "").empty());
  EXPECT_TRUE(warnings("0", R"({"grain_radius_m": 0.01})", "").empty());
  EXPECT_TRUE(warnings("30e3", R"({"grain_radius_m": 0.01})", R"(, "cohesion": 20e3)").empty()) << "a soil of its own";
}

TEST(SoilOfScenario, a_soil_taken_as_it_is_brings_its_measured_cone_index) {
  const auto cone_index = [](const std::string& cohesion, const std::string& radius, const std::string& more) {
    const ScenarioFile soil(R"({"format_version": 1, "terrain": {"friction": 0.4, "cohesion": )" + cohesion +
                            R"(}, "measured": {"grain_radius_m": 0.01, "cone_index_Pa": {"mean": 64e3}}})");
    return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"material": ")" + soil.path().string() +
                        R"(", "radius": )" + radius + more + "}}")
        .load()
        .terrain->describe()
        .cone_index;
  };
  EXPECT_EQ(cone_index("0", "0.01", ""), 64e3);
  EXPECT_EQ(cone_index("0", "0.01", R"(, "cone_index": 50e3)"), 50e3);
  EXPECT_EQ(cone_index("0", "0.01", R"(, "friction": 0.5)"), std::nullopt);
  EXPECT_EQ(cone_index("0", "0.006", ""), 64e3);
  EXPECT_EQ(cone_index("30e3", "0.006", ""), std::nullopt);
}

TEST(SoilOfScenario, a_soil_on_the_command_line_replaces_the_scenario_s_but_no_other_setting) {
  const ScenarioFile sand(R"({"format_version": 1, "terrain": {"friction": 0.4, "rolling_friction": 0.1},
                                       "measured": {"cone_index_Pa": {"mean": 64e3}}})");
  const ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"},
      "terrain": {"radius": 0.01, "friction": 0.9, "rolling_friction": 0.3, "cone_index": 340e3}})");
  const std::pair<std::string, std::string> soil{"terrain.material", '"' + sand.path().string() + '"'},
      friction{"terrain.friction", "0.7"}, index{"terrain.cone_index", "5e4"};
  const auto found = [&](const scenario::Settings& settings) {
    const scenario::Scenario s = file.load(settings);
    const terrain::dem::DemOptions grains = s.grains("");
    return std::tuple(grains.friction, grains.rolling_friction, s.terrain->describe().cone_index.value_or(-1.0));
  };
  EXPECT_EQ(found({soil}), std::tuple(0.4, 0.1, 64e3));
  EXPECT_EQ(found({friction, soil}), std::tuple(0.7, 0.1, -1.0)) << "changed, so its cone index is not known";
  EXPECT_EQ(found({soil, friction}), found({friction, soil}));
  EXPECT_EQ(found({index, soil}), std::tuple(0.4, 0.1, 5e4));

  const std::vector<std::string> kept = file.load({friction}).warnings;
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_TRUE(holds(kept[0],
                    "key 'terrain.cone_index': is 340e3 Pa, which the scenario states for its own soil, and "
                    "terrain.friction was set"));
  EXPECT_TRUE(file.load({friction, index}).warnings.empty());
  EXPECT_TRUE(file.load({{"terrain.layers", "12"}}).warnings.empty());
}

TEST(SoilOfScenario, keys_of_the_law_that_is_not_chosen_are_told) {
  const ScenarioFile file(kSmallest);
  const auto told = [&](const scenario::Settings& settings) {
    std::string all;
    for (const std::string& warning : file.load(settings).warnings) all += warning + "\n";
    return all;
  };
  EXPECT_TRUE(holds(told({{"terrain.normal_stiffness", "2e6"}}),
                    "key 'terrain.normal_stiffness': has no effect: the law is 'mindlin'"));
  const std::string other = told({{"terrain.law", "hertz_tanh"}, {"terrain.restitution", "0.9"}});
  EXPECT_TRUE(holds(other, "key 'terrain.restitution': has no effect: the law is 'hertz_tanh'"));
  EXPECT_FALSE(holds(told({{"terrain.restitution", "0.9"}}), "no effect"));
}

TEST(SoilOfScenario, empirical_soil_tells_its_modulus_under_a_small_wheel) {
  const auto share = [](double radius, double width, double load) {
    return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"engine": "scm",
        "bekker_k_c": -6905, "bekker_k_phi": 206700, "bekker_n": 0.284, "mohr_cohesion": 0, "mohr_friction_angle": 27,
        "janosi_k": 0.02}})")
        .load()
        .terrain->modulus_under(radius, width, load);
  };
  EXPECT_LT(share(0.058, 0.05, 24.5), 0.05) << "on the floor";
  EXPECT_GT(share(0.47, 0.25, 4600.0), 0.6);
  // b follows the contact: k_c/b + k_phi at b = w L/(w + L), with Bekker's sinkage of that modulus
  const double k = share(0.47, 0.25, 4600.0) * 206700.0,
               z = std::pow(4600.0 * 3.0 / ((3.0 - 0.284) * 0.25 * std::sqrt(0.94) * k), 1.0 / 0.784),
               length = std::sqrt(0.94 * z), b = 0.25 * length / (0.25 + length);
  EXPECT_NEAR(k, 206700.0 - 6905.0 / b, 1e-6 * k);
}

TEST(SoilOfScenario, a_soil_is_cohesive_above_the_cohesion_of_sand) {
  const auto cohesive = [](const std::string& terrain) {
    return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {)" + terrain + "}}")
        .load()
        .terrain->describe()
        .cohesive;
  };
  EXPECT_FALSE(cohesive(R"("cohesion": 24e3)")) << "c is 0.08 of it";
  EXPECT_TRUE(cohesive(R"("cohesion": 26e3)"));
  EXPECT_FALSE(cohesive(R"("engine": "scm", "mohr_cohesion": 1.9e3)"));
  EXPECT_TRUE(cohesive(R"("engine": "scm", "mohr_cohesion": 2.1e3)"));
}

TEST(SoilOfScenario, a_cone_index_leaves_the_digest_alone) {
  const ScenarioFile file(kSmallest);
  EXPECT_EQ(file.load({{"terrain.cone_index", "2e5"}}).digest, file.load().digest);
}

TEST(SoilOfScenario, mistakes_in_a_soil_file_are_named_with_that_file) {
  const auto complaint = [](const std::string& text) {
    const ScenarioFile soil(text), own(kSmallest);
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

/// The keys that are left out would be those of LETE sand, or of the scenario's own soil.
TEST(SoilOfScenario, a_soil_with_a_part_of_the_tests_of_empirical_soil_is_warned_of) {
  const auto told = [](const std::string& own, const std::string& soil) {
    const ScenarioFile part(R"({"format_version": 1, "terrain": )" + soil + "}");
    const ScenarioFile file(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"engine": "scm")" + own + "}}");
    const std::string name = soil.empty() ? "null" : '"' + part.path().string() + '"';
    return fmt::format("{}", fmt::join(file.load({{"terrain.material", name}}).warnings, "\n"));
  };
  const std::string plate = R"("bekker_k_c": 16.5e3, "bekker_k_phi": 811e3, "bekker_n": 0.73)",
                    shear = R"("mohr_cohesion": 1720, "mohr_friction_angle": 29, "janosi_k": 0.025)";
  const std::string open = "but not mohr_cohesion, mohr_friction_angle, janosi_k: these are the ";
  EXPECT_TRUE(holds(told("", "{" + plate + "}"), open + "scenario's or the defaults, of another soil"));
  EXPECT_TRUE(holds(told(", " + plate, ""), "key 'terrain.bekker_k_c': is given, " + open + "defaults"));
  EXPECT_EQ(told("", "{" + plate + ", " + shear + "}"), "");
  EXPECT_EQ(told(", " + plate + ", " + shear, ""), "");
  EXPECT_EQ(told("", ""), "");
}

TEST(SoilOfScenario, each_engine_takes_from_a_soil_file_what_is_its_own) {
  const ScenarioFile soil(R"({"format_version": 1, "terrain": {"rolling_friction": 0.2, "bekker_n": 0.5,
      "bekker_k_c": 16.5e3, "bekker_k_phi": 811e3, "mohr_cohesion": 1720, "mohr_friction_angle": 29,
      "janosi_k": 0.025}})");
  const ScenarioFile grains(kSmallest);
  const std::string name = '"' + soil.path().string() + '"';
  for (const std::string engine : {"dem", "scm"}) {
    // The engine may be chosen at any place among the settings.
    for (const bool first : {true, false}) {
      std::vector<std::pair<std::string, std::string>> settings{{"terrain.material", name}};
      settings.insert(first ? settings.begin() : settings.end(), {"terrain.engine", engine});
      const scenario::Scenario s = grains.load(settings);
      EXPECT_TRUE(s.warnings.empty()) << engine << first;
      const nlohmann::json terrain = nlohmann::json::parse(s.completed)["terrain"];
      EXPECT_EQ(terrain.value("rolling_friction", 0.2), 0.2);
      EXPECT_EQ(terrain.value("bekker_n", 0.5), 0.5);
      EXPECT_EQ(terrain.contains("bekker_n"), engine == "scm");
      EXPECT_EQ(terrain.contains("rolling_friction"), engine == "dem");
    }
  }
  const ScenarioFile other(R"({"format_version": 1, "terrain": {"bekker_n": 0.5}})");
  EXPECT_EQ(grains.complaint({{"terrain.material", '"' + other.path().string() + '"'}}, other.path()),
            ": key 'terrain': has keys of other engines alone (bekker_n), expected some of engine 'dem'");
}

TEST(SoilOfScenario, empirical_soil_needs_a_grid_finer_than_grousers) {
  const ScenarioFile file(R"({"rig": {"slip": 0.2, "load": 24.5}, "run": {"step": 1e-4}, "terrain": {"engine": "scm"},
      "tire": {"file": "rigid_drum.json", "rigid": true, "grousers": 24, "grouser_height": 0.005,
               "grouser_thickness": 0.004}})");
  EXPECT_EQ(file.complaint({{"terrain.grid_spacing", "0.0021"}}),
            ": key 'terrain.grid_spacing': is 0.0021 m, expected at most 0.002 m, half of tire.grouser_thickness: a "
            "node of the soil meets a thinner plate by chance");
  EXPECT_EQ(file.complaint({{"terrain.grid_spacing", "0.002"}}), "");
}

TEST(SoilOfScenario, bulk_density_determines_the_density_of_the_grains) {
  const ScenarioFile file(kSmallest);
  const auto loaded = file.load({{"terrain.solid_fraction", "0.56"}, {"terrain.bulk_density", "1400"}});
  EXPECT_DOUBLE_EQ(loaded.grains("").density, 2500.0);
  EXPECT_EQ(file.complaint({{"terrain.bulk_density", "1400"}}),
            ": key 'terrain.bulk_density': is 1400 kg/m³, but terrain.solid_fraction is not given; expected both");
}

}  // namespace
}  // namespace furrow
