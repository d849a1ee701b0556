// The sections `terrain` and `rig`: which model has which key.
#include <gtest/gtest.h>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "nodes/scenario/explain.hpp"
#include "nodes/scenario/model_keys.hpp"
#include "nodes/scenario/schema.hpp"
#include "protocol/files/json_text.hpp"
#include "rigs/rigs.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/terrains.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using nlohmann::json;
using testing::ScenarioFile;

/// A scenario whose section `terrain` is this text.
ScenarioFile with_terrain(const std::string& section) {
  return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": )" + section + "}");
}

/// "'dem' or 'rigid'".
std::string all_engines() {
  std::vector<std::string> names;
  for (const terrain::TerrainEntry& entry : terrain::terrains()) names.emplace_back(entry.name);
  return one_of(names);
}

TEST(TerrainKeys, every_engine_describes_itself_by_its_name) {
  for (const terrain::TerrainEntry& entry : terrain::terrains())
    EXPECT_EQ(entry.read(json::object(), {})->describe().engine, entry.name);
}

TEST(TerrainKeys, an_unknown_engine_is_refused_with_those_that_there_are) {
  EXPECT_EQ(with_terrain(R"({"engine": "clay"})").complaint(),
            ": key 'terrain.engine': is 'clay', expected " + all_engines());
  EXPECT_EQ(refusal(ExitCode::bad_input,
                    [&] {
                      terrain::find_terrain("clay", {"mine.json", "terrain"});
                    }),
            "mine.json: key 'terrain.engine': is 'clay', expected " + all_engines());
}

TEST(TerrainKeys, a_key_of_another_engine_is_an_error_in_a_scenario_written_for_its_own) {
  EXPECT_EQ(with_terrain(R"({"engine": "rigid", "radius": 0.01, "friction": 0.5})").complaint(),
            ": key 'terrain.radius': is a key of engine 'dem' or 'liggghts', but terrain.engine is 'rigid', "
            "expected keys of "
            "that engine alone");
  EXPECT_EQ(with_terrain(R"({"ground_damping": 1e4})").complaint().substr(0, 59),
            ": key 'terrain.ground_damping': is a key of engine 'rigid',");
  EXPECT_TRUE(with_terrain(R"({"ground_damping": 2.5e4})").load().warnings.empty()) << "the default";
}

/// In LIGGGHTS no grain sleeps, and every contact is computed in double precision.
TEST(TerrainKeys, ground_whose_uneven_part_no_wheel_meets_is_warned_of) {
  const auto far = with_terrain(R"({"engine": "rigid", "profile": [[700, 0], [730, 0], [740, 0.2]]})").load().warnings;
  ASSERT_EQ(far.size(), 1U);
  EXPECT_TRUE(holds(far[0], "key 'terrain.profile': is uneven from x = 730 to 740 m, and no wheel comes there"))
      << far[0];
  EXPECT_TRUE(holds(far[0], "rig.start places them")) << far[0];
  const auto road = with_terrain(R"({"engine": "rigid", "road_class": "C", "road_from": 1000})").load().warnings;
  ASSERT_EQ(road.size(), 1U);
  EXPECT_TRUE(holds(road[0], "key 'terrain.road_class': is uneven from x = 1000 to 1100 m")) << road[0];
  for (const char* const met : {R"({"engine": "rigid", "profile": [[0, 0], [1, 0.1]]})",
                                R"({"engine": "rigid", "profile": [[0, 0.1], [1000, 0.1]]})"})
    EXPECT_TRUE(with_terrain(met).load().warnings.empty()) << met;
}

/// How far a steered vehicle drives is not known; a road of keys may begin ahead of it.
TEST(TerrainKeys, a_vehicle_that_starts_beside_a_road_is_warned_of) {
  const auto told = [](const std::string& terrain, const char* start) {
    const ScenarioFile file(R"({"rig": {"type": "vehicle", "vehicle": "hmmwv.json"}, "tire": {"rigid": true},
                               "terrain": )" +
                            terrain + "}");
    std::ofstream(file.path().parent_path() / "road.csv") << "x_m,z_m\n20,0\n30,0.1\n40,0\n";
    return fmt::format("{}", fmt::join(file.load({{"rig.start", start}}).warnings, "\n"));
  };
  const std::string road = R"({"engine": "rigid", "profile_file": "road.csv"})",
                    drawn = R"({"engine": "rigid", "road_class": "A"})";
  EXPECT_EQ(told(road, "22"), "");
  EXPECT_TRUE(
      holds(told(road, "5"), "'terrain.profile_file': is uneven from x = 20 to 40 m, and the wheels start from"))
      << told(road, "5");
  EXPECT_TRUE(holds(told(road, "5"), "rig.start or terrain.profile_from places them"));
  EXPECT_EQ(told(drawn, "3"), "");
  EXPECT_TRUE(holds(told(drawn, "300"), "'terrain.road_class': is uneven from x = 5 to 105 m, and the wheels start"));
}

TEST(TerrainKeys, heights_of_empirical_soil_are_warned_of_where_they_are_steep) {
  const auto told = [](double rise) {
    const ScenarioFile file = with_terrain(R"({"engine": "scm", "profile_file": "ramp.csv"})");
    std::ofstream(file.path().parent_path() / "ramp.csv") << "x_m,z_m\n0,0\n10," << rise << "\n";
    const scenario::Scenario s = file.load();
    EXPECT_EQ(s.terrain->files().size(), 1U);
    EXPECT_FALSE(s.terrain->describe().undisturbed_height);
    return fmt::format("{}", fmt::join(s.warnings, "\n"));
  };
  EXPECT_EQ(told(2.0), "");
  EXPECT_TRUE(holds(told(4.0), "key 'terrain.profile_file': rises by 22° at its steepest, expected at most 15°"))
      << told(4.0);
}

TEST(TerrainKeys, ground_that_bends_within_the_contact_of_a_handling_tire_is_warned_of) {
  const auto told = [](const char* terrain) {
    const ScenarioFile file(fmt::format(R"({{"tire": {{"file": "hmmwv_handling.json"}}, "rig": {{"start": 1}},
                                             "run": {{"end": 3}}, "terrain": {}}})",
                                        terrain));
    return fmt::format("{}", fmt::join(file.load().warnings, "\n"));
  };
  EXPECT_FALSE(holds(told(R"({"engine": "rigid", "profile": [[0, 0], [40, 4]]})"), "bends by"));
  EXPECT_FALSE(holds(told(R"({"engine": "rigid", "road_class": "A", "road_from": 1})"), "bends by"));
  const std::string curb = told(R"({"engine": "rigid", "profile": [[2, 0], [2, 0.1]]})");
  EXPECT_TRUE(holds(curb, "key 'terrain.profile': bends by 50.0 mm within the ")) << curb;
  EXPECT_TRUE(holds(curb, "takes the mean height and slope there")) << curb;
}

TEST(TerrainKeys, what_an_engine_cannot_do_is_refused_even_where_it_is_the_default) {
  for (const char* key : {R"("activity": true)", R"("precision": "mixed")"}) {
    const std::string text = fmt::format(R"({{"engine": "liggghts", {}}})", key);
    EXPECT_TRUE(holds(with_terrain(text).complaint(), "is a key of engine 'dem', but terrain.engine is 'liggghts'"));
  }
  const scenario::Scenario s = with_terrain(R"({"activity": true})").load({{"terrain.engine", "liggghts"}});
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(s.warnings[0].ends_with("keys of other engines are ignored: activity")) << s.warnings[0];
}

TEST(TerrainKeys, an_engine_chosen_on_the_command_line_sets_keys_of_others_aside_with_one_warning) {
  const scenario::Scenario s = with_terrain(R"({"radius": 0.01, "length": 4, "layers": 15, "friction": 0.5})")
                                   .load({{"terrain.engine", "rigid"}});
  EXPECT_EQ(s.terrain->describe().engine, "rigid");
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(
      s.warnings[0].ends_with("key 'terrain.engine': is 'rigid'; keys of other engines are ignored: length, radius"))
      << s.warnings[0];
  const json section = json::parse(s.completed)["terrain"];
  EXPECT_EQ(section["friction"], 0.5);
  EXPECT_FALSE(section.contains("radius"));
  EXPECT_TRUE(section.contains("ground_stiffness"));
}

/// A key may move from one engine to another; runs with this key continue.
TEST(TerrainKeys, completed_scenarios_of_runs_say_so_and_may_hold_keys_of_other_engines) {
  json document = json::parse(ScenarioFile(testing::kSmallest).load({{"terrain.engine", "rigid"}}).completed);
  EXPECT_TRUE(document["completed_by"].get<std::string>().starts_with("furrow "));
  document["terrain"]["length"] = 4.0;
  EXPECT_EQ(ScenarioFile(document.dump()).load().warnings.size(), 1U);
  document.erase("completed_by");
  EXPECT_TRUE(holds(ScenarioFile(document.dump()).complaint(), "key 'terrain.length'"));
}

/// As if the drawbar rig had all keys except `slip`, which is a trolley's, and both had `speed`.
std::vector<std::string> two_kinds(const std::string& key) {
  if (key == "slip") return {"trolley"};
  if (key == "speed") return {"drawbar", "trolley"};
  return rigs::kinds_of_key(key);
}

TEST(RigKeys, a_key_of_another_type_is_refused_or_set_aside_as_those_of_engines_are) {
  const scenario::ModelSection rig{"rig", "type", "drawbar", two_kinds};
  const scenario::Schema& schema = scenario::Schema::of_scenarios();
  const auto set_aside = [&](json& document, const std::vector<std::pair<std::string, std::string>>& settings) {
    return scenario::set_aside_keys(document, schema, "mine.json", settings, {&rig, 1});
  };
  const json given = {{"rig", {{"slip", 0.2}, {"speed", 3.0}}}, {"terrain", json::object()}};
  json document = given;
  EXPECT_EQ(refusal(ExitCode::bad_input, [&] { set_aside(document, {}); }),
            "mine.json: key 'rig.slip': is a key of type 'trolley', but rig.type is 'drawbar', expected keys of "
            "that type alone");
  document = given;
  EXPECT_EQ(set_aside(document, {{"rig.type", "drawbar"}}),
            std::vector<std::string>{"mine.json: key 'rig.type': is 'drawbar'; keys of other types are ignored: slip"});
  EXPECT_EQ(document["rig"], json({{"speed", 3.0}}));
  document["rig"]["type"] = "trolley";
  EXPECT_TRUE(set_aside(document, {}).empty());
  EXPECT_TRUE(document["rig"].contains("speed")) << "both take it";
}

TEST(RigKeys, explain_says_whose_key_it_is) {
  EXPECT_TRUE(holds(scenario::explain("rig.slip"), "type     drawbar\n"));
  EXPECT_EQ(scenario::explain("rig.substeps").find("type     "), std::string::npos);
}

TEST(ModelKeys, a_scenario_that_is_refused_is_not_told_what_was_set_aside) {
  const std::string told =
      with_terrain(R"({"radius": 0.01, "length": 4})").complaint({{"terrain.engine", "rigid"}, {"run.end", "1e-9"}});
  EXPECT_TRUE(holds(told, "run.end"));
  EXPECT_EQ(told.find("are ignored"), std::string::npos) << told;
}

TEST(TerrainKeys, tools_that_need_grains_say_why_and_which_engine_has_them) {
  const ScenarioFile file(testing::kSmallest);
  EXPECT_EQ(file.load({{"run.seed", "7"}}).grains("why").seed, 7U);
  expect_refused(ExitCode::bad_input,
                 {"key 'terrain.engine': is 'rigid', expected 'dem' or 'liggghts': only grains keep a rut"}, [&] {
                   (void)file.load({{"terrain.engine", "rigid"}}).grains("only grains keep a rut");
                 });
}

TEST(TerrainKeys, explain_says_which_engines_take_a_key) {
  EXPECT_TRUE(holds(scenario::explain("terrain.radius"), "engine   dem, liggghts\n"));
  EXPECT_TRUE(holds(scenario::explain("terrain.friction"), "engine   dem, rigid, liggghts\n"));
  EXPECT_EQ(scenario::explain("terrain.substeps").find("engine   "), std::string::npos);
}

}  // namespace
}  // namespace furrow
