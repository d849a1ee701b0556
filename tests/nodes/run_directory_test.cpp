// The folder of a run. One run at a time has it; only files written by furrow are removed from it; old results survive
// a run that never started.
#include "nodes/launch/run_directory.hpp"

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "nodes/launch/held_folder.hpp"
#include "nodes/output/frames.hpp"
#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;
using launch::RunDirectory, launch::RunList;

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
std::string read(const fs::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text);
  return text;
}

std::string error_of(const std::function<void()>& work, ExitCode code = ExitCode::bad_input) {
  return refusal(code, work);
}

/// All files below a folder, by their paths in it.
std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!entry.is_directory()) files.insert(entry.path().lexically_relative(folder).string());
  return files;
}

class RunFolderTest : public ::testing::Test {
 protected:
  /// Writes results as in a run: names first, then files.
  static void write_results(const RunDirectory& run, const std::string& text) {
    run.add({"scenario.json", "summary.json", "frames/", "frames/tire%1d_%06d.h5"});
    for (const char* name : {"scenario.json", "summary.json"}) write(run.path() / name, text);
    fs::create_directory(run.path() / "frames");
    write(run.path() / "frames" / "tire0_000001.h5", text);
    write(run.path() / "frames" / ".tire0_000002.h5.0123456789abcdef.part", text);
  }
  void make_run(const std::string& text) {
    const RunDirectory run("test", run_, fs::exists(run_) && !fs::is_empty(run_));
    write_results(run, text);
  }

  testing::TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "deep" / "run";
};

TEST(RunList, names_with_numbers_are_those_that_printf_makes) {
  std::int64_t number = -1;
  EXPECT_TRUE(launch::is_of_form("frames/tire0_000042.h5", "frames/tire%1d_%06d.h5", &number));
  EXPECT_EQ(number, 42);
  for (const char* name : {"tire0_1000000.h5", "tire12_000000.h5"})
    EXPECT_TRUE(launch::is_of_form(name, "tire%1d_%06d.h5")) << name;
  for (const char* name : {"tire0_00042.h5", "tire0_0000042.h5", "tire00_000042.h5", "tire0_000042.h5x",
                           "tire_000042.h5", "tire0_-00042.h5", "tire0_9999999999999999999.h5", "tire0_.h5", ""})
    EXPECT_FALSE(launch::is_of_form(name, "tire%1d_%06d.h5")) << name;
  EXPECT_TRUE(launch::is_of_form("summary.json", "summary.json"));
  EXPECT_FALSE(launch::is_of_form("summary-json", "summary.json"));
}

TEST(RunList, only_the_last_list_counts_and_a_line_cut_short_is_no_name) {
  const testing::TemporaryFolder folder;
  launch::begin_run_list(folder.path(), {"soil.json"});
  launch::begin_run_list(folder.path(), {"summary.json"});
  EXPECT_EQ(RunList::read(folder.path()).forms(), std::vector<std::string>{"summary.json"});
  std::ofstream(folder.path() / launch::kRunList, std::ios::app) << "fram";
  EXPECT_EQ(RunList::read(folder.path()).forms(), std::vector<std::string>{"summary.json"});
  launch::add_to_run_list(folder.path(), {"rut.png", "summary.json"});
  EXPECT_EQ(RunList::read(folder.path()).forms(), (std::vector<std::string>{"summary.json", "rut.png"}));
}

TEST(RunList, one_that_was_tampered_with_or_is_of_another_version_is_refused) {
  const testing::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    write(folder.path() / launch::kRunList, text);
    return error_of([&] { RunList::read(folder.path()); });
  };
  for (const char* name : {"../victim", "/etc/passwd", "frames/../../victim", "a\tb", ""})
    EXPECT_TRUE(
        holds(refusal(std::string("furrow-run 1\n") + name + "\n"), "is not the name of a file below its folder"))
        << name;
  EXPECT_TRUE(holds(refusal("furrow-run 2\na\n"), "is of version '2', expected 1"));
  EXPECT_TRUE(holds(refusal("summary.json\n"), "is not a list of a run's files"));
  EXPECT_EQ(refusal(""), "") << "killed before its first line";
}

TEST(RunList, a_file_that_furrow_did_not_write_is_never_written_over) {
  const testing::TemporaryFolder folder;
  launch::begin_run_list(folder.path(), {});
  write(folder.path() / "rut.png", "mine");
  EXPECT_TRUE(
      holds(error_of([&] { launch::add_to_run_list(folder.path(), {"rut.png"}); }), "rut.png: stands where a result"));
  EXPECT_TRUE(RunList::read(folder.path()).forms().empty());
}

TEST(RunList, links_are_not_followed) {
  const testing::TemporaryFolder folder;
  const fs::path run = folder.path() / "run", elsewhere = folder.path() / "elsewhere";
  fs::create_directory(run), fs::create_directory(elsewhere);
  launch::begin_run_list(run, {"frames/", "frames/terrain_%06d.h5"});
  write(elsewhere / "terrain_000001.h5", "mine");
  fs::create_directory_symlink(elsewhere, run / "frames");
  launch::remove_listed(run, RunList::read(run));
  launch::remove_listed(run, RunList::read(run), "frames/");
  EXPECT_EQ(read(elsewhere / "terrain_000001.h5"), "mine");
}

TEST_F(RunFolderTest, takes_an_empty_folder_and_no_other_without_overwrite) {
  fs::create_directories(run_);
  make_run("new");
  EXPECT_EQ(read(run_ / "summary.json"), "new");
  EXPECT_TRUE(holds(error_of([&] { RunDirectory("test", run_, false); }), "exists already"));
  const fs::path other = folder_.path() / "other";
  fs::create_directory(other);
  write(other / "letter.txt", "mine");
  EXPECT_TRUE(holds(error_of([&] { RunDirectory("test", other, false); }), "exists already"));
  EXPECT_EQ(files_in(other), std::set<std::string>{"letter.txt"});
}

TEST_F(RunFolderTest, one_run_at_a_time_has_it_until_its_last_process_ends) {
  using launch::FolderLock;
  const pid_t child = [&] {
    RunDirectory first("test", run_, false);
    write_results(first, "first");
    const pid_t process = fork();  // like mpirun: it holds the folder after the supervisor has ended
    if (process == 0) {
      first.lock().share();
      pause();
      _exit(0);
    }
    return process;
  }();
  while (error_of([&] { const launch::HeldFolder rank(run_); }) != "") usleep(1000);
  const std::string told = error_of([&] { FolderLock(run_, "--out", FolderLock::Mode::alone, 0.2); });
  EXPECT_TRUE(holds(told, "is in use by a run that has not ended: process " + std::to_string(child) + " ("));
  std::optional<launch::HeldFolder> rank;
  rank.emplace(run_);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_NE(error_of([&] { FolderLock(run_, "--out", FolderLock::Mode::alone, 0.0); }), "") << "a rank lives";
  rank.reset();
  const RunDirectory second("test", run_, true);
  EXPECT_FALSE(fs::exists(run_ / "scenario.json"));
  EXPECT_NE(error_of([&] { const launch::HeldFolder other(run_); }), "") << "not before it is shared";
}

TEST_F(RunFolderTest, a_run_that_waits_has_it_as_soon_as_the_last_process_ends) {
  make_run("first");
  const pid_t child = fork();
  if (child == 0) {
    const launch::HeldFolder rank(run_);
    write(folder_.path() / "held", "");
    usleep(700000);
    _exit(0);
  }
  while (!fs::exists(folder_.path() / "held")) usleep(1000);
  const RunDirectory second(run_);
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), child) << "it was not waited for";
}

TEST_F(RunFolderTest, files_of_the_users_own_survive_what_overwrites_the_run) {
  make_run("first");
  for (const char* name : {"photo.png", "summary_of_my_thesis.json", "timeseries_measured.csv", "report.json",
                           "frames/cad.step", "frames/tire0_12.h5", "frames/tire0_000001.h5.bak"})
    write(run_ / name, "mine");
  fs::create_directory(run_ / "checkpoints");
  write(run_ / "checkpoints" / "notes.txt", "mine");
  make_run("second");
  for (const char* name :
       {"photo.png", "summary_of_my_thesis.json", "timeseries_measured.csv", "report.json", "frames/cad.step",
        "frames/tire0_12.h5", "frames/tire0_000001.h5.bak", "checkpoints/notes.txt"})
    EXPECT_EQ(read(run_ / name), "mine") << name;
  EXPECT_EQ(read(run_ / "summary.json"), "second");
  EXPECT_FALSE(fs::exists(run_ / ".furrow-before"));
}

TEST_F(RunFolderTest, all_that_furrow_wrote_goes_and_empty_folders_with_it) {
  make_run("first");
  {
    const RunDirectory second("test", run_, true);
    EXPECT_EQ(read(run_ / ".furrow-before" / "summary.json"), "first");
    second.add({"timeseries.csv"});  // it begins to step
  }
  EXPECT_EQ(files_in(run_), std::set<std::string>{launch::kRunList});
  EXPECT_FALSE(fs::exists(run_ / "frames"));
}

TEST_F(RunFolderTest, a_folder_that_no_run_made_is_refused) {
  fs::create_directories(run_ / "frames");
  write(run_ / "scenario.json", "mine");
  write(run_ / "frames" / "tire0_000001.h5", "mine");
  for (const bool overwrite : {true, false})
    EXPECT_TRUE(
        holds(error_of([&] { RunDirectory("test", run_, overwrite); }), overwrite ? "holds no run" : "exists already"));
  EXPECT_TRUE(holds(error_of([&] { RunDirectory::of_study(run_); }), "holds no run's list"));
  EXPECT_TRUE(holds(error_of([&] { RunDirectory go_on(run_); }), "an earlier version of furrow made it"));
  EXPECT_EQ(files_in(run_), (std::set<std::string>{"scenario.json", "frames/tire0_000001.h5"}));
}

TEST_F(RunFolderTest, an_empty_folder_may_be_taken_and_is_given_back_empty) {
  fs::create_directories(run_);
  {
    RunDirectory run("test", run_, true);
    write_results(run, "first");
    run.discard();
  }
  EXPECT_TRUE(fs::is_empty(run_));
}

TEST_F(RunFolderTest, results_come_back_when_the_run_that_replaces_them_never_came_to_be) {
  make_run("first");
  write(run_ / "notes.txt", "mine");
  const std::set<std::string> before = files_in(run_);
  {
    RunDirectory second("test", run_, true);
    EXPECT_FALSE(fs::exists(run_ / "summary.json"));
    second.add({"timeseries.csv"});
    write_results(second, "second");
    write(run_ / "timeseries.csv", "second");
    second.discard();
  }
  EXPECT_EQ(read(run_ / "scenario.json"), "first");
  EXPECT_EQ(read(run_ / "frames" / "tire0_000001.h5"), "first");
  EXPECT_EQ(files_in(run_), before);
  make_run("third");
  EXPECT_EQ(read(run_ / "summary.json"), "third") << "what came back is still known as furrow's";
}

TEST_F(RunFolderTest, results_come_back_when_a_run_is_killed_before_it_came_to_be) {
  make_run("first");
  const std::set<std::string> before = files_in(run_);
  const pid_t child = fork();
  if (child == 0) {
    const RunDirectory second("test", run_, true, run_ / "scenario.json");
    second.add({"run.log"});
    write(run_ / "run.log", "second");
    _exit(0);  // without cleaning up
  }
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(fs::exists(run_ / "summary.json"));
  {
    RunDirectory third("test", run_, true);
    third.discard();
  }
  EXPECT_EQ(read(run_ / "summary.json"), "first");
  EXPECT_TRUE(std::ranges::includes(files_in(run_), before));
}

TEST_F(RunFolderTest, the_scenario_that_is_still_to_be_read_stays_and_comes_back) {
  make_run("first");
  RunDirectory second("test", run_, true, fs::relative(run_ / "scenario.json"));
  EXPECT_EQ(read(run_ / "scenario.json"), "first");
  EXPECT_FALSE(fs::exists(run_ / "summary.json"));
  write_results(second, "second");
  second.discard();
  EXPECT_EQ(read(run_ / "scenario.json"), "first");
  EXPECT_EQ(read(run_ / "summary.json"), "first");
}

TEST_F(RunFolderTest, nothing_is_left_of_a_new_folder_whose_run_never_came_to_be) {
  {
    RunDirectory run("test", run_, false);
    write_results(run, "first");
    run.discard();
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "deep"));
}

TEST_F(RunFolderTest, a_way_through_a_folder_that_is_not_there_is_refused) {
  const fs::path out = folder_.path() / "none" / ".." / "out";
  EXPECT_TRUE(holds(error_of([&] { RunDirectory("test", out, false); }), "leads through"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  fs::create_directory(folder_.path() / "none");
  const RunDirectory run("test", out / "", false);
  EXPECT_TRUE(fs::exists(folder_.path() / "out"));
}

TEST_F(RunFolderTest, the_folder_of_a_calibration_is_never_overwritten_by_a_run) {
  const fs::path calibration = folder_.path() / "calibration";
  RunDirectory::of_calibration(calibration, false).add({"calibration.json", "evaluations.csv"});
  write(calibration / "evaluations.csv", "");
  EXPECT_TRUE(holds(error_of([&] { RunDirectory("test", calibration, true); }), "holds a calibration"));
  EXPECT_TRUE(fs::exists(calibration / "evaluations.csv"));
}

TEST_F(RunFolderTest, the_folder_of_a_study_is_no_runs_and_that_of_a_run_no_studys) {
  const fs::path study = folder_.path() / "study";
  RunDirectory::of_study(study).add({"sweep.json"});
  write(study / "sweep.json", "{}");
  EXPECT_TRUE(holds(error_of([&] { RunDirectory("test", study, true); }), "holds a study"));
  RunDirectory::of_study(study);
  make_run("first");
  EXPECT_TRUE(holds(error_of([&] { RunDirectory::of_study(run_); }), "holds a run"));
}

TEST_F(RunFolderTest, a_rank_notices_that_the_folder_or_one_in_it_is_gone) {
  const auto told = [](launch::HeldFolder& held) { return error_of([&] { held.check(); }, ExitCode::io); };
  make_run("first");
  launch::HeldFolder held(run_);
  EXPECT_EQ(told(held), "");
  fs::rename(run_ / "frames", folder_.path() / "frames");
  EXPECT_TRUE(holds(told(held), "frames: was moved or removed"));
  fs::create_directory(run_ / "frames");
  EXPECT_TRUE(holds(told(held), "frames: was moved or removed")) << "another one of that name";
  fs::rename(run_, folder_.path() / "elsewhere");
  EXPECT_TRUE(holds(told(held), "run: was moved, removed or emptied"));
  make_run("another");
  EXPECT_TRUE(holds(told(held), "run: was moved, removed or emptied"));
}

}  // namespace
}  // namespace furrow
