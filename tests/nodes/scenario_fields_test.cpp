// Schema and options hold together: every key of a section is read by a field with the same default and unit, and every
// field that is a key is in the schema.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "nodes/scenario/load_scenario.hpp"
#include "nodes/scenario/schema.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/rigs.hpp"
#include "tests/nodes/key_lists.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tire/tires.hpp"

namespace furrow {
namespace {

using nlohmann::json;

/// The field's value after reading `given` in place of its default.
template <class T>
T read_one(const std::string& name, const json& given) {
  T values;
  read_fields(json{{name, given}}, values);
  return values;
}

/// Every value of the struct, those of a field left out; enough to see whether two structs are equal.
template <class T>
std::vector<std::pair<std::string, std::string>> texts(const T& values) {
  std::vector<std::pair<std::string, std::string>> all;
  visit_fields(
      [&](const Field& field, const auto& value) {
        if constexpr (requires { json(value); })
          all.emplace_back(field.name, json(value).dump());
        else
          all.emplace_back(field.name, "");
      },
      values);
  return all;
}

/// Adds the names of the struct's keys to `read`, each checked against the schema's.
template <class T>
void expect_as_schema(const std::string& section, std::set<std::string>& read) {
  const scenario::Schema schema = scenario::Schema::load();
  const T defaults{};
  visit_fields(
      [&](const Field& field, const auto&) {
        if (!field.is(role::key)) return;
        const std::string key = section + "." + field.name;
        EXPECT_TRUE(read.insert(field.name).second) << key << " is read twice";
        const json* known = schema.find(key);
        ASSERT_NE(known, nullptr) << key;
        EXPECT_EQ(known->value("unit", ""), field.unit) << key;
        json standard = known->value("default", json());
        if (key == "run.threads") {
          EXPECT_EQ(standard, "auto");
          standard = 0;
        }
        EXPECT_EQ(texts(read_one<T>(field.name, standard)), texts(defaults)) << key;
      },
      defaults);
}

template <class... Structs>
void expect_section(const std::string& section, const std::set<std::string>& lists = {}) {
  std::set<std::string> read = lists;
  (expect_as_schema<Structs>(section, read), ...);
  const scenario::Schema schema = scenario::Schema::load();
  ASSERT_NE(schema.find(section), nullptr) << section;
  std::set<std::string> known;
  for (const auto& [name, unused] : schema.find(section)->at("properties").items()) known.insert(name);
  EXPECT_EQ(read, known) << section;
}

TEST(ScenarioFields, are_the_keys_of_the_schema_with_its_defaults_and_units) {
  expect_section<rigs::DrawbarWheel>("rig.wheels.0");
  expect_section<tire::TireOptions>("tire");
  expect_section<tire::TireOptions>("tires.0");
  expect_section<scenario::RunOptions>("run");
  expect_section<scenario::OutputOptions>("output");
  expect_section<scenario::CheckpointOptions>("checkpoint");
  expect_section<scenario::PressKeys>("press");
  expect_section<scenario::ExpectedResult>("expected");
}

/// Two kinds may share a key: the schema has one default for both.
TEST(ScenarioFields, keys_of_every_kind_of_rig_are_those_of_the_schema) {
  std::vector<KeyList> lists{key_list<rigs::RigOptions>()};
  for (const rigs::RigKind& kind : rigs::rig_kinds()) lists.push_back(kind.keys);
  testing::expect_keys_of_schema("rig", lists);
}

TEST(ScenarioFields, a_value_in_place_of_the_default_arrives_in_its_field) {
  EXPECT_EQ(read_one<rigs::DrawbarWheel>("lateral", 0.3).rig.lateral, 0.3);
  EXPECT_EQ(read_one<rigs::DrawbarRigOptions>("travel_sign", -1).travel_sign, -1.0);
  EXPECT_EQ(read_one<tire::TireOptions>("file", "x.json").file, "x.json");
  EXPECT_EQ(read_one<tire::TireOptions>("pressure", 3e5).pressure, (tire::PressureSchedule{{{0.0, 3e5}}}));
  EXPECT_EQ(read_one<tire::TireOptions>("pressure", json::array({{0.5, 2e5}, {1.0, 1e5}})).pressure,
            (tire::PressureSchedule{{{0.5, 2e5}, {1.0, 1e5}}}));
  EXPECT_EQ(read_one<tire::TireOptions>("friction", nullptr).friction, -1.0);
}

TEST(ScenarioFields, the_schema_lists_the_kinds_of_rigs_that_there_are) {
  json names = json::array();
  for (const rigs::RigKind& kind : rigs::rig_kinds()) names.push_back(std::string(kind.name));
  const scenario::Schema schema = scenario::Schema::load();
  EXPECT_EQ(schema.find("rig.type")->at("enum"), names);
}

/// A key that a later version adds changes no digest of scenarios that do not state it, and no run that lacks it.
TEST(ScenarioFields, a_key_that_is_the_default_counts_like_one_that_is_missing) {
  const testing::ScenarioFile file(testing::kSmallest);
  const scenario::Scenario s = file.load();
  EXPECT_EQ(file.load({{"terrain.friction", "0.9"}, {"rig.slip", "0.3"}}).digest, s.digest);
  EXPECT_NE(file.load({{"terrain.friction", "0.8"}}).digest, s.digest);
  EXPECT_NE(file.load({{"terrain.engine", "rigid"}}).digest, s.digest);
  json earlier = json::parse(s.completed);
  earlier["rig"].erase("toe_ramp");
  earlier["terrain"].erase("size_spread");
  EXPECT_EQ(testing::ScenarioFile(earlier.dump()).load().digest, s.digest);
}

/// The soil of a run is found from any folder, and is the same soil.
TEST(ScenarioFields, a_soil_file_of_ones_own_has_its_full_name_in_the_completed_scenario) {
  const testing::ScenarioFile file(
      R"({"tire": {"file": "hmmwv_layered.json"}, "terrain": {"material": "mysand.json"}})");
  const std::filesystem::path soil = file.path().parent_path() / "mysand.json";
  std::ofstream(soil) << R"({"format_version": 1, "terrain": {"friction": 0.4}})";
  const scenario::Scenario s = file.load();
  EXPECT_EQ(json::parse(s.completed)["terrain"]["material"], soil.string());
  const testing::ScenarioFile elsewhere(s.completed);
  EXPECT_EQ(elsewhere.load().completed, s.completed);
  EXPECT_EQ(elsewhere.load().digest, s.digest);
  EXPECT_NE(file.load({{"terrain.friction", "0.5"}}).digest, s.digest);
}

TEST(ScenarioFields, what_is_harmless_is_free_on_resume_and_leaves_the_digest) {
  const testing::ScenarioFile file(testing::kSmallest);
  const std::string digest = file.load().digest;
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{{"run.threads", "2"},
                                                                                   {"run.peer_timeout", "5"},
                                                                                   {"checkpoint.keep", "3"},
                                                                                   {"checkpoint.interval", "1"},
                                                                                   {"terrain.cache", "false"},
                                                                                   {"description", "other"}}) {
    EXPECT_TRUE(scenario::may_change_on_resume(key)) << key;
    EXPECT_EQ(file.load({{key, value}}).digest, digest) << key;
  }
  EXPECT_TRUE(scenario::may_change_on_resume("run.end"));
  EXPECT_TRUE(scenario::may_change_on_resume("output.frame_interval"));
  EXPECT_TRUE(scenario::may_change_on_resume("expected.drawbar_pull"));
  EXPECT_FALSE(scenario::may_change_on_resume("run.step"));
  EXPECT_FALSE(scenario::may_change_on_resume("rig.type"));
}

}  // namespace
}  // namespace furrow
