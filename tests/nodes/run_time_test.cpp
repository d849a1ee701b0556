// The wall time of a run from the speed of a machine.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "nodes/scenario/grain_loads.hpp"
#include "nodes/scenario/machine_speed.hpp"
#include "nodes/scenario/run_time.hpp"
#include "nodes/scenario/validate.hpp"
#include "protocol/files/data_files.hpp"
#include "tests/nodes/scenario_fixture.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr scenario::MachineSpeed kMachine{.grain_step = 5e-8, .tire_step = 2e-3, .tire_coordinates = 4680, .cores = 2};

scenario::RunTime time_of(const char* name, Settings settings = {}, scenario::MachineSpeed machine = kMachine) {
  if (std::string(name) != "rigid_ground.json") settings.emplace_back("terrain.cache", "false");
  const scenario::Scenario s = scenario::load_scenario(data_folder() / "rigs" / name, settings);
  return scenario::run_time(s, machine);
}

/// By hand: 25,000 steps. The tire takes 1.2 × 2 ms and 0.08 ms for its messages; the terrain takes less. Together they
/// take less than two cores have in that time.
TEST(RunTime, the_slowest_node_decides_where_there_are_cores_for_all) {
  const scenario::RunTime t = time_of("drawbar_pull_small_report_soil.json");
  EXPECT_NEAR(t.tire, 2.48e-3, 1e-9);
  EXPECT_LT(t.terrain, t.tire);
  EXPECT_NEAR(t.run, 25000 * 2.53e-3, 1.0);
  EXPECT_GT(t.bed, 1.0);
  EXPECT_EQ(t.threads, 1);
}

TEST(RunTime, tires_share_the_cores_that_there_are) {
  const Settings flexible{
      {"tire.elements_circumference", "60"}, {"tire.elements_width", "12"}, {"tire.rigid", "false"}};
  scenario::MachineSpeed machine = kMachine;
  const double on_two = time_of("four_wheels.json", flexible, machine).step;
  EXPECT_GT(on_two, 4e-3);  // four tires of 2.4 ms on two cores
  EXPECT_LT(on_two, 6.5e-3);
  machine.cores = 16;
  const double on_many = time_of("four_wheels.json", flexible, machine).step;
  EXPECT_NEAR(on_many, 2.53e-3, 1e-4);
}

/// Rigid tires, 0.5 m from each other in rows of four, on 3,484 to 26,779 grains.
scenario::RunTime time_of_wheels(int count, double frames_every = 0.0, double checkpoints_every = 0.0) {
  nlohmann::json s = nlohmann::json::parse(R"({
      "rig": {"slip": 0, "mode": "fixed_angular_speed", "angular_speed": 0, "carrier_mass": 450},
      "tire": {"file": "hmmwv_layered.json", "rigid": true},
      "terrain": {"radius": 0.03, "cohesion": 80e3, "layers": 4, "width": 2.1, "cache": false},
      "run": {"step": 1e-4, "end": 0.1, "average_from": 0.05}})");
  for (int k = 0; k < count; ++k)
    s["rig"]["wheels"].push_back({{"start", 0.7 + 1.1 * (k / 4)}, {"lateral", -0.75 + 0.5 * (k % 4)}});
  s["terrain"]["length"] = 1.4 + 1.1 * ((count + 3) / 4);
  s["output"]["frame_interval"] = frames_every;
  s["checkpoint"] = {{"interval", checkpoints_every}, {"at_end", false}};
  return scenario::run_time(testing::ScenarioFile(s.dump()).load(), kMachine);
}

/// Measured on two cores: a step took 1.1 ms with 4 wheels, 4.6 with 16 and 32 with 64; the ranks began and ended in
/// 0.6, 0.65, 1.1 and 6.4 s with 1, 4, 16 and 64 wheels (tests/benchmarks/start_of_ranks.csv).
TEST(RunTime, many_ranks_for_each_core_begin_later_and_take_longer_for_their_messages) {
  const auto about = [](double told, double measured) { return told > measured / 1.5 && told < 1.5 * measured; };
  for (const auto& [wheels, step] : {std::pair{4, 1.1e-3}, {16, 4.6e-3}, {64, 32e-3}})
    EXPECT_PRED2(about, time_of_wheels(wheels).step, step) << wheels;
  for (const auto& [wheels, start] : {std::pair{1, 0.6}, {4, 0.65}, {16, 1.1}, {64, 6.4}})
    EXPECT_PRED2(about, time_of_wheels(wheels).start, start) << wheels;
}

/// Measured on two cores: 100 frames took 0.13, 2.0 and 6.9 s with 1, 16 and 64 wheels, 100 checkpoints 0.87, 6.3 and
/// 21 (tests/benchmarks/writing_time.csv).
TEST(RunTime, frames_and_checkpoints_take_as_long_as_their_files) {
  const auto about = [](double told, double measured) { return told > measured / 2.0 && told < 2.0 * measured; };
  for (const auto& [wheels, frames, checkpoints] : {std::tuple{1, 0.13, 0.87}, {16, 2.0, 6.3}, {64, 6.9, 21.0}}) {
    EXPECT_PRED2(about, time_of_wheels(wheels, 1e-3).writing, frames) << wheels;
    EXPECT_PRED2(about, time_of_wheels(wheels, 0.0, 1e-3).writing, checkpoints) << wheels;
  }
  EXPECT_EQ(time_of_wheels(1).writing, 0.0);
}

TEST(RunTime, sleeping_tiled_and_kept_beds_take_less) {
  const scenario::RunTime awake = time_of("drawbar_pull.json", {{"terrain.activity", "false"}});
  const scenario::RunTime asleep = time_of("drawbar_pull.json");
  EXPECT_EQ(awake.awake, 1.0);
  EXPECT_EQ(time_of("drawbar_pull_tr.json").awake, 1.0);  // no static friction, so no grain sleeps
  EXPECT_NEAR(asleep.awake, 0.115, 0.005);  // by hand: 2 × 0.574 m of 10 m, all of it where the bin does not end
  EXPECT_LT(asleep.terrain, 0.25 * awake.terrain);
  const scenario::RunTime tiled = time_of("drawbar_pull.json", {{"terrain.width", "0.6"}, {"terrain.tile", "1"}});
  EXPECT_LT(tiled.bed, 0.5 * asleep.bed);
  const scenario::RunTime rigid = time_of("rigid_ground.json");
  EXPECT_EQ(rigid.bed, 0.0);
  EXPECT_LT(rigid.terrain, 1e-3);  // the surface alone
}

/// Means over runs, by tests/benchmarks/estimates.py, and 0.26 of a wheel beside one wall of a bed 3 m wide
/// (tests/studies/sleep_across.csv).
TEST(RunTime, awake_shares_are_within_a_third_of_those_of_runs) {
  const auto about = [](double told, double measured) { return told > measured / 1.5 && told < 1.5 * measured; };
  for (const auto& [name, measured] : {std::pair{"drawbar_pull_small.json", 0.33},
                                       {"drawbar_pull_small_report_soil.json", 0.31},
                                       {"first_look.json", 0.54},
                                       {"four_wheels.json", 0.93},
                                       {"hmmwv_small.json", 0.30},
                                       {"rover_small.json", 0.35},
                                       {"hmmwv_turn.json", 0.158},
                                       {"small_wheel.json", 0.473}})
    EXPECT_PRED2(about, time_of(name).awake, measured) << name;
  const double wide = time_of("drawbar_pull_small_report_soil.json", {{"terrain.width", "3"},
                                                                      {"terrain.radius", "0.015"},
                                                                      {"terrain.layers", "8"},
                                                                      {"tire.rigid", "true"},
                                                                      {"rig.wheels", R"([{"lateral": -1.0}])"},
                                                                      {"run.step", "1e-4"}})
                          .awake;
  EXPECT_PRED2(about, wide, 0.26);
}

/// By hand: 24,330 grains over two ranks, and 8,110 a metre within 22 mm of the border, at 3.2 times 50 ns.
TEST(RunTime, ranks_of_one_core_share_the_grains_and_step_copies_of_their_neighbours) {
  const auto on = [](const char* ranks, Settings more = {}) {
    more.insert(more.end(), {{"terrain.engine", "liggghts"}, {"terrain.ranks", ranks}});
    return time_of("drawbar_pull_small_report_soil.json", more);
  };
  const scenario::RunTime one = on("1"), two = on("2"), four = on("4", {{"run.threads", "3"}});
  EXPECT_EQ(one.ghosts, 0.0);
  EXPECT_NEAR(two.ghosts, 178.4, 0.5);
  EXPECT_NEAR(four.ghosts, 2.0 * two.ghosts, 0.1);
  EXPECT_NEAR(one.terrain, 24330 * 3.2 * 5e-8, 0.02 * one.terrain);
  EXPECT_NEAR(two.terrain / one.terrain, 0.5 + 178.4 / 24330.0, 0.01);
  EXPECT_EQ(four.threads, 1);
  EXPECT_EQ(four.awake, 1.0);
  EXPECT_GT(four.step, 0.5 * one.terrain);  // on the machine's two cores
}

/// Within a factor of three of measured runs: 0.76 of the time in hmmwv_straight, 0.28 in hmmwv_small, 0.21 in
/// rover_small, 0.94 in drawbar_pull_small, none in drawbar_pull_small_report_soil.
TEST(RunTime, hard_contacts_take_more_steps) {
  const auto between = [](double value, double low, double high) { return value >= low && value <= high; };
  const scenario::RunTime straight = time_of("hmmwv_straight.json");
  EXPECT_PRED3(between, straight.refined, 0.25, 1.0);
  EXPECT_PRED3(between, time_of("hmmwv_small.json").refined, 0.09, 0.84);
  EXPECT_PRED3(between, time_of("rover_small.json").refined, 0.07, 0.63);
  EXPECT_PRED3(between, time_of("drawbar_pull_small.json").refined, 0.31, 1.0);
  EXPECT_LT(time_of("drawbar_pull_small_report_soil.json").refined, 1e-3);
  const double whole = time_of("hmmwv_straight.json", {{"terrain.substeps", "4"}}).terrain;
  EXPECT_LT(straight.terrain, whole);  // all of them in halves
  EXPECT_GT(straight.terrain, 0.6 * whole);
}

/// Runs with moduli of 25 and 6 MPa ended after 1.6 and 0.2 s; with the shipped moduli they did not.
TEST(GrainLoads, overlaps_that_end_a_run_are_foreseen_with_the_key_that_moves_them) {
  const auto bound = [](const char* name, Settings settings) {
    const scenario::Scenario s = scenario::load_scenario(data_folder() / "rigs" / name, settings);
    return scenario::too_hard(s, scenario::grain_loads(s));
  };
  for (const char* name : {"hmmwv_straight.json", "hmmwv_small.json", "rover_small.json", "first_look.json",
                           "drawbar_pull_small_report_soil.json", "four_wheels.json", "hmmwv_turn.json"})
    EXPECT_FALSE(bound(name, {})) << name << ": " << bound(name, {})->what;
  for (const auto& [name, modulus] :
       {std::pair{"hmmwv_straight.json", "2.49e7"}, {"drawbar_pull_small_report_soil.json", "6.2e6"}}) {
    const auto found = bound(name, {{"terrain.young_modulus", modulus}});
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->key, "terrain.young_modulus");
    EXPECT_TRUE(holds(found->what, " %: expected about "));
  }
}

TEST(RunTime, a_report_tells_it_where_it_is_known) {
  const scenario::Scenario s = scenario::load_scenario(data_folder() / "rigs" / "first_look.json", {});
  EXPECT_FALSE(scenario::validation_report(s).contains("time"));
  const scenario::RunTime t = scenario::run_time(s, kMachine);
  EXPECT_NEAR(scenario::validation_report(s, &t)["time"]["all_s"].get<double>(), t.all(), 1e-9);
  EXPECT_TRUE(holds(scenario::validation_text(s, &t), "\ntime         about "));
}

/// A kept speed is used as it is; a damaged one is measured again and kept.
TEST(MachineSpeed, is_kept_and_measured_again_when_damaged) {
  const testing::TemporaryFolder folder;
  const char* const set = std::getenv("XDG_CACHE_HOME");
  const std::string before = set ? set : "";
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const scenario::MachineSpeed first = scenario::machine_speed();
  EXPECT_GT(first.grain_step, 1e-9);
  EXPECT_LT(first.grain_step, 1e-5);
  EXPECT_GT(first.tire_step, 1e-5);
  EXPECT_EQ(first.tire_coordinates, 4680);
  const std::filesystem::path kept = std::filesystem::directory_iterator(folder.path() / "furrow" / "speed")->path();
  std::ofstream(kept) << R"({"grain_step_s": 1e-7, "tire_step_s": 1e-3, "tire_coordinates": 4680})";
  EXPECT_EQ(scenario::machine_speed().grain_step, 1e-7);
  std::ofstream(kept) << R"({"grain_step_s": "fast)";
  EXPECT_NE(scenario::machine_speed().grain_step, 1e-7);
  EXPECT_NE(scenario::machine_speed().tire_step, 1e-3);
  before.empty() ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace furrow
