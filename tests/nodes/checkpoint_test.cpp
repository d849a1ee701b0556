// Checkpoints on disk: whole or refused; series and frames continue where they were.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/checkpoint/run_summary.hpp"
#include "nodes/checkpoint/wall_schedule.hpp"
#include "nodes/output/frames.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::TemporaryFolder;

/// A checkpoint with two parts, at `step`, in the run's folder.
checkpoint::CheckpointManifest write_example(const fs::path& run, std::int64_t step, int keep = 10) {
  checkpoint::CheckpointManifest m;
  m.version = "0.1.0", m.build = "b", m.cpu = "c", m.name = "example";
  m.scenario = R"({"rig":{"slip":0.3,"toe_angle":1e-17},"run":{"seed":1}})";
  m.scenario_digest = "d";
  m.file_hashes = {"1", "2"};
  m.step = step;
  m.time = 1e-4 * static_cast<double>(step);
  m.series = {{100, 7, "s", "wheel0"}};
  m.frames = {20, 0, 0};
  m.segments = {{0, 50, 1.25, 2, "", ""}, {50, step, 0.1, 1, R"({"run.threads":1})", "0123"}};
  const fs::path folder = checkpoint::unfinished_checkpoint(run, step);
  fs::create_directories(folder);
  for (const char* name : {"rig.h5", "terrain.h5"}) {
    Archive archive;
    archive.put("x", std::vector<double>{1.0 / 3.0, static_cast<double>(step)});
    write_archive(folder / name, archive);
    m.parts.push_back({step, name, checkpoint::part_checksum(folder / name), ""});
  }
  checkpoint::complete_checkpoint(run, m, keep);
  return m;
}

std::string error_of(const fs::path& folder) {
  return refusal(ExitCode::io, [&] { checkpoint::read_checkpoint(folder); });
}

TEST(Checkpoint, what_was_written_is_read) {
  const testing::TemporaryFolder folder;
  const checkpoint::CheckpointManifest written = write_example(folder.path(), 120);
  const auto found = checkpoint::list_checkpoints(folder.path());
  ASSERT_EQ(found.size(), 1U);
  const checkpoint::CheckpointManifest read = checkpoint::read_checkpoint(found[0]);
  EXPECT_EQ(read.step, 120);
  EXPECT_EQ(read.time, written.time);
  EXPECT_EQ(read.scenario, written.scenario);
  EXPECT_EQ(read.series.at(0).lines, 7);
  EXPECT_EQ(read.series.at(0).subject, "wheel0");
  EXPECT_EQ(read.frames.every, 20);
  EXPECT_EQ(read.file_hashes, written.file_hashes);
  ASSERT_EQ(read.segments.size(), 2U);
  EXPECT_EQ(read.segments[1].changed, R"({"run.threads":1})");
  EXPECT_EQ(read.segments[1].finer_than, "0123");
  EXPECT_EQ(std::distance(fs::directory_iterator(checkpoint::checkpoints_folder(folder.path())), {}), 1);
}

TEST(Checkpoint, the_newest_are_kept) {
  const testing::TemporaryFolder folder;
  for (const int step : {10, 30, 20, 40}) write_example(folder.path(), step, 2);
  const auto found = checkpoint::list_checkpoints(folder.path());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(checkpoint::read_checkpoint(found[0]).step, 40);
  EXPECT_EQ(checkpoint::read_checkpoint(found[1]).step, 30);
}

TEST(Checkpoint, one_at_the_same_step_is_replaced) {
  const testing::TemporaryFolder folder;
  write_example(folder.path(), 10);
  write_example(folder.path(), 10);
  EXPECT_EQ(error_of(checkpoint::list_checkpoints(folder.path()).at(0)), "");
}

TEST(Checkpoint, a_manifest_with_any_byte_changed_or_cut_is_refused) {
  const testing::TemporaryFolder folder;
  write_example(folder.path(), 10);
  const fs::path checkpoint = checkpoint::list_checkpoints(folder.path()).at(0), file = checkpoint / "manifest.json";
  const std::string whole = read_whole_file(file);
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    if (std::isspace(static_cast<unsigned char>(whole[i]))) continue;
    std::string bad = whole;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    std::ofstream(file, std::ios::binary) << bad;
    EXPECT_NE(error_of(checkpoint), "") << "byte " << i << " of " << bad;
    std::ofstream(file, std::ios::binary) << whole.substr(0, i);
    EXPECT_NE(error_of(checkpoint), "") << "cut at " << i;
  }
  std::ofstream(file, std::ios::binary) << whole;
  EXPECT_EQ(error_of(checkpoint), "");
}

TEST(Checkpoint, one_of_another_format_is_refused_by_its_version) {
  const testing::TemporaryFolder folder;
  write_example(folder.path(), 10);
  const fs::path checkpoint = checkpoint::list_checkpoints(folder.path()).at(0);
  for (const int version : {2, 4}) {
    std::ofstream(checkpoint / "manifest.json")
        << R"({"kind": "checkpoint", "checksum": "0", "format_version": )" << version << "}";
    EXPECT_TRUE(error_of(checkpoint)
                    .starts_with(fmt::format("{}: has format_version {}, but this program reads 3",
                                             (checkpoint / "manifest.json").string(), version)));
  }
}

/// Puts a value into the manifest of the run's only checkpoint, with a valid checksum. @returns its folder
fs::path forge(const fs::path& run, const std::string& pointer, const Json& value) {
  const fs::path checkpoint = checkpoint::list_checkpoints(run).at(0), file = checkpoint / "manifest.json";
  Json manifest = Json::parse(read_whole_file(file));
  manifest[Json::json_pointer(pointer)] = value;
  manifest.erase("checksum");
  manifest["checksum"] = text_hash(manifest.dump());
  std::ofstream(file, std::ios::binary) << manifest.dump();
  return checkpoint;
}

TEST(Checkpoint, a_scenario_that_no_program_completed_is_refused) {
  for (const char* text : {"3", "\"x\"", "[1]", R"({"terrain": {"engine": 3}})", R"({"rig": 3})",
                           R"({"tire": {"substeps": "two"}})", R"({"run": {"step": "x"}})"}) {
    const testing::TemporaryFolder folder;
    std::ofstream(folder.path() / "scenario.json")
        << R"({"tire": {"file": "toroidal.json"}, "terrain": {"engine": "rigid"}})";
    write_example(folder.path(), 10);
    forge(folder.path(), "/scenario", Json::parse(text));
    EXPECT_THROW(checkpoint::plan_resume(folder.path(), {{"run.step", "1e-6"}}), Error) << text;
  }
}

TEST(RunSummary, a_place_that_no_list_has_is_no_entry) {
  const Json summary{{"wheels", {1, 2}}};
  EXPECT_EQ(checkpoint::value_at(summary, "wheels.1"), 2);
  for (const char* path : {"wheels.2", "wheels.-1", "wheels.", "wheels.99999999999999999999999999"})
    EXPECT_TRUE(checkpoint::value_at(summary, path).is_null()) << path;
}

TEST(Checkpoint, what_was_never_completed_is_no_checkpoint) {
  const testing::TemporaryFolder folder;
  write_example(folder.path(), 10);
  fs::create_directories(checkpoint::unfinished_checkpoint(folder.path(), 20));
  fs::create_directories(checkpoint::checkpoints_folder(folder.path()) / "mine");
  EXPECT_EQ(checkpoint::list_checkpoints(folder.path()).size(), 1U);
  write_example(folder.path(), 30);
  checkpoint::remove_checkpoints_after(folder.path(), 10);
  EXPECT_EQ(checkpoint::list_checkpoints(folder.path()).size(), 1U);
  EXPECT_FALSE(fs::exists(checkpoint::unfinished_checkpoint(folder.path(), 20)));
  EXPECT_TRUE(fs::exists(checkpoint::checkpoints_folder(folder.path()) / "mine"));
}

TEST(FrameClock, numbers_go_on_without_gap_when_the_interval_changes) {
  const checkpoint::FrameClock first{20, 0, 0};
  EXPECT_EQ(first.index(0), 0);
  EXPECT_EQ(first.index(100), 5);
  const checkpoint::FrameClock second = first.continued(110, 50);  // frames of steps 0 … 100 are written: 0 … 5
  EXPECT_EQ(second.index(150), 6);
  EXPECT_EQ(second.index(200), 7);
  EXPECT_EQ(second.continued(200, 0).index(999), 7);
  EXPECT_EQ(second.continued(200, 0).continued(300, 100).index(300), 7);
  EXPECT_EQ(second.continued(200, 0, true).index(999), 8) << "the frame of the step, number 7, stays";
  EXPECT_EQ(second.continued(200, 50, true).index(200), 7) << "it is made again";
  EXPECT_EQ(second.continued(200, 50).index(200), 7) << "the frame of the step itself is still to come";
}

TEST(FrameClock, numbers_stay_when_steps_are_counted_in_parts) {
  const checkpoint::FrameClock whole{5, 10, 3}, thirds{15, 30, 3};
  for (std::int64_t step = 10; step < 60; ++step) EXPECT_EQ(thirds.index(3 * step), whole.index(step)) << step;
}

/// A run of a minute has a checkpoint; a run of an hour has no more than requested.
TEST(WallSchedule, begins_early_and_slows_down_to_its_interval) {
  const auto times = [](double interval, double until) {
    checkpoint::WallSchedule schedule{interval, 100.0};
    std::vector<double> at;
    for (double t = 100.0; t <= 100.0 + until; t += 1.0)
      if (schedule.due(t)) at.push_back(t - 100.0), schedule.written(t);
    return at;
  };
  EXPECT_EQ(times(600.0, 2800.0), (std::vector<double>{30, 90, 210, 450, 930, 1530, 2130, 2730}));
  EXPECT_EQ(times(10.0, 45.0), (std::vector<double>{10, 20, 30, 40}));
  EXPECT_TRUE(times(0.0, 1000.0).empty());
}

TEST(RunSummary, keys_of_a_wheel_are_at_the_top_only_if_it_is_the_only_one) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& wheels) {
    write_whole_file(folder.path() / "summary.json", R"({"grains": 5, "wheels": [)" + wheels + "]}");
    return checkpoint::read_summary(folder.path());
  };
  const std::string steady = R"({"sinkage_m": 0.01, "drawbar_pull_N": {"mean": 7, "steady": true}})",
                    unsteady = R"({"sinkage_m": 0.02, "drawbar_pull_N": {"mean": 9, "steady": false}})";
  EXPECT_EQ(read(steady)["sinkage_m"], 0.01);
  const Json both = read(steady + "," + unsteady);
  EXPECT_FALSE(both.contains("sinkage_m"));
  EXPECT_EQ(both["drawbar_pull_N"], Json({{"steady", false}}));
  EXPECT_EQ(read(steady + "," + steady)["drawbar_pull_N"], Json({{"steady", true}}));
  EXPECT_EQ(read(unsteady + "," + steady)["drawbar_pull_N"], Json({{"steady", false}}));
  EXPECT_FALSE(read(R"({"sinkage_m": 1}, {"sinkage_m": 2})").contains("drawbar_pull_N")) << "a vehicle";
}

}  // namespace
}  // namespace furrow
