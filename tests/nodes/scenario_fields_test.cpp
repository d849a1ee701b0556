// Keys set the fields of their names; some count for the digest of a scenario.
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "nodes/scenario/load_scenario.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/drawbar_spec.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tire/tires.hpp"

namespace furrow {
namespace {

using nlohmann::json;

/// The field's value after reading `given` instead of its default.
template <class T>
T read_one(const std::string& name, const json& given) {
  T values;
  read_fields(json{{name, given}}, values);
  return values;
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

/// A key of a later version does not change the digest of scenarios without it, or runs without it.
TEST(ScenarioFields, a_key_that_is_the_default_counts_like_one_that_is_missing) {
  const testing::ScenarioFile file(testing::kSmallest);
  const scenario::Scenario s = file.load();
  EXPECT_EQ(file.load({{"terrain.friction", "0.9"}, {"rig.slip", "0.3"}}).digest, s.digest);
  EXPECT_EQ(file.load({{"rig.carrier_mass", "450.0"}, {"terrain.layers", "15.0"}}).digest, s.digest);
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
  for (const char* key : {"run.end", "output.frame_interval", "expected.drawbar_pull"})
    EXPECT_TRUE(scenario::may_change_on_resume(key)) << key;
  for (const char* key : {"run.step", "run.seed", "rig.slip", "rig.type", "terrain.bed", "tire.file", "run.end_of",
                          "outputs", "tire.pressure.1.0"})
    EXPECT_FALSE(scenario::may_change_on_resume(key)) << key;
  EXPECT_NE(file.load({{"rig.carrier_mass", "451"}}).digest, digest);
  EXPECT_NE(file.load({{"run.seed", "2"}}).digest, digest);
}

}  // namespace
}  // namespace furrow
