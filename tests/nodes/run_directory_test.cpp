// The folder of a run: one run at a time has it, and results to be overwritten survive a run that never came to be.
#include "nodes/launch/run_directory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "protocol/core/error.hpp"
#include "tests/nodes/temporary_folder.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
std::string read(const fs::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text);
  return text;
}

class RunFolderTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "deep" / "run";
};

TEST_F(RunFolderTest, one_run_at_a_time_has_it) {
  std::optional<launch::RunDirectory> first;
  first.emplace("test", run_, false);
  write(run_ / "scenario.json", "first");
  EXPECT_THROW(launch::RunDirectory("test", run_, true), Error);
  EXPECT_EQ(read(run_ / "scenario.json"), "first");
  first.reset();
  const launch::RunDirectory second("test", run_, true);
  EXPECT_FALSE(fs::exists(run_ / "scenario.json"));
}

TEST_F(RunFolderTest, results_come_back_when_the_run_that_replaces_them_never_came_to_be) {
  { const launch::RunDirectory first("test", run_, false); }
  write(run_ / "scenario.json", "first");
  write(run_ / "summary_wheel1.json", "first");
  write(run_ / "notes.txt", "mine");
  {
    launch::RunDirectory second("test", run_, true);
    EXPECT_FALSE(fs::exists(run_ / "summary_wheel1.json"));
    write(run_ / "scenario.json", "second");
    write(run_ / "timeseries.csv", "second");
    second.discard();
  }
  EXPECT_EQ(read(run_ / "scenario.json"), "first");
  EXPECT_EQ(read(run_ / "summary_wheel1.json"), "first");
  EXPECT_EQ(read(run_ / "notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(run_ / "timeseries.csv"));
  EXPECT_FALSE(fs::exists(run_ / ".before"));
}

TEST_F(RunFolderTest, nothing_is_left_of_a_new_folder_whose_run_never_came_to_be) {
  {
    launch::RunDirectory run("test", run_, false);
    write(run_ / "scenario.json", "first");
    fs::create_directory(run_ / "frames");
    run.discard();
  }
  EXPECT_FALSE(fs::exists(folder_.path() / "deep"));
}

}  // namespace
}  // namespace furrow
