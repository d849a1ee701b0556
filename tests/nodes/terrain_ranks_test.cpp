// A terrain of several ranks in one process: the strip mat of tests/dummies gives the same bits on any number of them.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "nodes/ranks/run_node.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "nodes/scenario/scenario_checks.hpp"
#include "protocol/transport_group.hpp"
#include "tests/dummies/strip_mat.hpp"
#include "tests/nodes/in_process_run.hpp"
#include "tests/nodes/small_scenarios.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using testing::InProcessRun;

scenario::Scenario wheel_on_mat(int ranks) {
  testing::OneWheel wheel = testing::rigid_wheel_on_plane();
  wheel.wheel_rig.touchdown_damping = 0.0;
  scenario::Scenario s = wheel.made();
  s.terrain = terrain::read_strip_mat({{"length", 3.0}}, {"scenario.json", "terrain"});
  s.terrain_ranks = ranks;
  return s;
}

constexpr std::int64_t kHalf = 300, kEnd = 600;

TEST(TerrainRanks, rig_and_tire_feel_the_same_bits_from_any_number_of_them) {
  InProcessRun one(wheel_on_mat(1));
  one.steps(0, kEnd);
  const std::vector<Archive> saved = one.save();
  EXPECT_LT(saved[2].get<double>("strip_mat/impulse").back(), 0.0) << "the wheel never touched the mat";
  for (const int ranks : {2, 3, 5}) {
    InProcessRun several(wheel_on_mat(ranks));
    several.steps(0, kEnd);
    const std::vector<std::uint64_t> expected = one.hashes(), found = several.hashes();
    ASSERT_EQ(found.size(), static_cast<std::size_t>(2 + ranks));
    EXPECT_EQ(found[0], expected[0]) << "rig, " << ranks << " ranks";
    EXPECT_EQ(found[1], expected[1]) << "tire, " << ranks << " ranks";
  }
}

TEST(TerrainRanks, restored_they_continue_bit_for_bit) {
  InProcessRun whole(wheel_on_mat(3));
  whole.steps(0, kHalf);
  InProcessRun resumed(wheel_on_mat(3));
  resumed.restore(whole.save());
  whole.steps(kHalf, kEnd), resumed.steps(kHalf, kEnd);
  EXPECT_EQ(whole.hashes(), resumed.hashes());
}

TEST(TerrainRanks, each_has_its_name_in_the_table_of_ranks) {
  std::vector<std::string> names;
  for (const scenario::RankEntry& entry : scenario::rank_table(wheel_on_mat(3))) names.push_back(entry.node);
  EXPECT_EQ(names, (std::vector<std::string>{"rig", "tire 0", "terrain 0", "terrain 1", "terrain 2"}));
  EXPECT_EQ(scenario::rank_table(wheel_on_mat(1)).back().node, "terrain");
}

/// Runs `work` on each rank of a terrain of three, with a rig and a tire that do nothing.
std::vector<std::string> play(const std::function<void(Transport&, RankGroup&)>& work) {
  auto transports = make_in_process_transports(1, 3);
  std::vector<std::string> ends(3);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < 3; ++k)
    threads.emplace_back([&, k] {
      Transport& transport = *transports[2 + k];
      try {
        transport.set_peer_timeout(1.0);
        work(transport, *make_terrain_group(transport));
      } catch (const Error& error) {
        ends[k] = error.what();
        if (!dynamic_cast<const PeerFailure*>(&error)) transport.announce_failure(error.code(), error.what());
      }
    });
  for (auto& thread : threads) thread.join();
  return ends;
}

TEST(TerrainRanks, what_they_tell_each_other_comes_in_their_order) {
  std::vector<std::vector<int>> seen(3);
  const auto ends = play([&](Transport&, RankGroup& group) {
    std::vector<int> own(static_cast<std::size_t>(group.rank()), 10 + group.rank());  // none, {11}, {12, 12}
    seen[group.rank()] = gather_on_all<int>(group, own);
  });
  EXPECT_EQ(ends, std::vector<std::string>(3));
  for (const auto& values : seen) EXPECT_EQ(values, (std::vector<int>{11, 12, 12}));
}

TEST(TerrainRanks, one_that_falls_silent_is_named) {
  const auto ends = play([](Transport&, RankGroup& group) {
    if (group.rank() == 2) std::this_thread::sleep_for(std::chrono::seconds(3));
    group.gather({});
    group.broadcast({});
  });
  // Either of the others may time out first: it has waited for the silent rank, or for the rank that waits for it.
  EXPECT_TRUE(holds(ends[0], "terrain 2 does not answer; raise run.peer_"));
}

TEST(TerrainRanks, an_engine_that_cannot_use_them_is_refused_by_key) {
  scenario::Scenario s = wheel_on_mat(9);
  s.file = "scenario.json";
  s.run.average_from = 0.1;
  const std::shared_ptr<rigs::RigSpec> rig = std::const_pointer_cast<rigs::RigSpec>(s.rig);
  EXPECT_EQ(refusal(ExitCode::bad_input, [&] { scenario::check_scenario(s, *rig, scenario::Purpose::run); }),
            "scenario.json: key 'terrain.ranks': is 9, expected 1 to 8: engine 'strip_mat' runs on no more");
}

}  // namespace
}  // namespace furrow
