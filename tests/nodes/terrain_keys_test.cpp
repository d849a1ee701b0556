// The section `terrain`: its keys in the schema and in the engines' lists of fields, and whose key is whose.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "nodes/scenario/engine_keys.hpp"
#include "nodes/scenario/explain.hpp"
#include "nodes/scenario/schema.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/rigid/ground_options.hpp"
#include "terrain/terrains.hpp"
#include "tests/nodes/scenario_fixture.hpp"

namespace furrow {
namespace {

using nlohmann::json;
using testing::ScenarioFile;

/// A scenario whose section `terrain` is this text.
ScenarioFile with_terrain(const std::string& section) {
  return ScenarioFile(R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": )" + section + "}");
}

/// A value that stands for null: a text that is empty, or a negative number.
template <class T>
bool stands_for_null(const T& value) {
  if constexpr (std::is_same_v<T, std::string>)
    return value.empty();
  else
    return value < T{};
}

template <HasFields T>
void expect_as_in_the_schema(std::set<std::string>& keys) {
  const scenario::Schema schema = scenario::Schema::load();
  const T options{};
  visit_fields(
      [&](const Field& field, const auto& value) {
        if (!field.is(role::key)) return;
        keys.insert(std::string("terrain.") + field.name);
        const json* node = schema.find(std::string("terrain.") + field.name);
        ASSERT_NE(node, nullptr) << field.name;
        const json standard = node->value("default", json());
        EXPECT_TRUE(standard.is_null() ? stands_for_null(value) : standard == json(value)) << field.name;
        const bool number = std::is_arithmetic_v<std::decay_t<decltype(value)>> &&
                            !std::is_same_v<std::decay_t<decltype(value)>, bool>;
        EXPECT_EQ(node->value("unit", number ? "-" : ""), field.unit) << field.name;
      },
      options);
}

TEST(TerrainKeys, schema_and_fields_have_the_same_keys_defaults_and_units) {
  std::set<std::string> of_fields;
  expect_as_in_the_schema<terrain::CommonOptions>(of_fields);
  expect_as_in_the_schema<terrain::dem::DemOptions>(of_fields);
  expect_as_in_the_schema<terrain::GroundOptions>(of_fields);
  const std::vector<std::string> known = scenario::Schema::load().keys("terrain");
  EXPECT_EQ(of_fields, std::set<std::string>(known.begin(), known.end()));
}

TEST(TerrainKeys, schema_and_table_name_the_same_engines) {
  std::set<std::string> names;
  for (const terrain::TerrainEntry& entry : terrain::terrains()) {
    names.insert(entry.name);
    EXPECT_EQ(entry.read(json::object(), {})->describe().engine, entry.name);
  }
  EXPECT_EQ(scenario::Schema::load().find("terrain.engine")->at("enum").get<std::set<std::string>>(), names);
}

TEST(TerrainKeys, an_unknown_engine_is_refused_with_those_that_there_are) {
  EXPECT_EQ(with_terrain(R"({"engine": "clay"})").complaint(),
            ": key 'terrain.engine': is 'clay', expected 'dem' or 'rigid'");
  EXPECT_EQ(with_terrain(R"({"engine": "liggghts"})").complaint(),
            ": key 'terrain.engine': 'liggghts' is not available in this version, expected 'dem' or 'rigid'");
  try {
    terrain::find_terrain("clay", {"mine.json", "terrain"});
    ADD_FAILURE() << "was found";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "mine.json: key 'terrain.engine': is 'clay', expected 'dem' or 'rigid'");
  }
}

TEST(TerrainKeys, a_key_of_another_engine_is_an_error_in_a_scenario_written_for_its_own) {
  EXPECT_EQ(
      with_terrain(R"({"engine": "rigid", "radius": 0.01, "friction": 0.5})").complaint(),
      ": key 'terrain.radius': is a key of engine 'dem', but terrain.engine is 'rigid', expected keys of "
      "that engine alone");
  EXPECT_EQ(with_terrain(R"({"ground_damping": 1e4})").complaint().substr(0, 59),
            ": key 'terrain.ground_damping': is a key of engine 'rigid',");
  EXPECT_TRUE(with_terrain(R"({"ground_damping": 2.5e4})").load().warnings.empty()) << "the default";
}

TEST(TerrainKeys, an_engine_chosen_on_the_command_line_sets_keys_of_others_aside_with_one_warning) {
  const scenario::Scenario s = with_terrain(R"({"radius": 0.01, "length": 4, "layers": 15, "friction": 0.5})")
                                   .load({{"terrain.engine", "rigid"}});
  EXPECT_EQ(s.terrain->describe().engine, "rigid");
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_TRUE(s.warnings[0].ends_with(
      "key 'terrain.engine': is 'rigid'; keys of other engines are set aside: length, radius"))
      << s.warnings[0];
  const json section = json::parse(s.completed)["terrain"];
  EXPECT_EQ(section["friction"], 0.5);
  EXPECT_FALSE(section.contains("radius"));
  EXPECT_TRUE(section.contains("ground_stiffness"));
}

/// Earlier versions completed scenarios with the keys of all engines.
TEST(TerrainKeys, completed_scenarios_of_earlier_versions_are_read) {
  json document = json::parse(testing::kSmallest);
  scenario::Schema::load().fill_defaults(document);
  document["terrain"]["engine"] = "rigid";
  EXPECT_TRUE(ScenarioFile(document.dump()).load().warnings.empty());
  document["terrain"]["length"] = 4.0;
  const scenario::Scenario s = ScenarioFile(document.dump()).load();
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_NE(s.warnings[0].find("set aside: length"), std::string::npos) << s.warnings[0];
  EXPECT_EQ(ScenarioFile(s.completed).load().digest, s.digest);
  scenario::remove_keys_of_other_engines(document);
  EXPECT_EQ(document["terrain"], json::parse(s.completed)["terrain"]);
}

TEST(TerrainKeys, tools_that_need_grains_say_why_and_which_engine_has_them) {
  const ScenarioFile file(testing::kSmallest);
  EXPECT_EQ(file.load({{"run.seed", "7"}}).grains("why").seed, 7U);
  try {
    (void)file.load({{"terrain.engine", "rigid"}}).grains("only grains keep a rut");
    ADD_FAILURE() << "rigid ground has grains";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("key 'terrain.engine': is 'rigid', expected 'dem': only grains keep a rut"),
              std::string::npos)
        << error.what();
  }
}

TEST(TerrainKeys, explain_says_which_engines_take_a_key) {
  EXPECT_NE(scenario::explain("terrain.radius").find("engine   dem\n"), std::string::npos);
  EXPECT_NE(scenario::explain("terrain.friction").find("engine   dem, rigid\n"), std::string::npos);
  EXPECT_EQ(scenario::explain("terrain.substeps").find("engine   "), std::string::npos);
}

}  // namespace
}  // namespace furrow
