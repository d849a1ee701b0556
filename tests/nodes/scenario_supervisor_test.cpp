// The supervisor's two inputs: lines of the ranks, and mpirun's own messages.
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "nodes/launch/progress.hpp"
#include "nodes/launch/supervisor_lines.hpp"
#include "nodes/launch/supervisor_text.hpp"

namespace furrow {
namespace {

TEST(RankLine, survives_the_way_to_the_supervisor) {
  launch::RankLine line{
      launch::RankLine::Kind::error, 2, "a \"quoted\" text\nin two lines, 3 µm", ExitCode::physics, {}};
  std::string text = launch::encode(line);
  ASSERT_EQ(text.find('\n'), text.size() - 1);
  text.pop_back();
  const auto error = launch::decode(text);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind, launch::RankLine::Kind::error);
  EXPECT_EQ(error->rank, 2);
  EXPECT_EQ(error->text, line.text);
  EXPECT_EQ(error->code, ExitCode::physics);

  line = {
      launch::RankLine::Kind::progress, 0, {}, ExitCode::done, {"running", 0.25, 0.5, 2.0, 1432.5, 0.031, 1.4, 83.0}};
  const auto progress = launch::decode(launch::encode(line));
  ASSERT_TRUE(progress);
  EXPECT_EQ(progress->progress.phase, "running");
  EXPECT_EQ(progress->progress.pull, 1432.5);
  EXPECT_EQ(progress->progress.eta, 83.0);
  line.progress.pull = std::nan("");  // of a rig that has none
  const auto without = launch::decode(launch::encode(line));
  ASSERT_TRUE(without);
  EXPECT_EQ(launch::progress_text(without->progress).find("pull"), std::string::npos);
}

TEST(RankLine, fits_into_one_write_to_a_pipe) {
  const launch::RankLine line{launch::RankLine::Kind::error, 0, std::string(100000, '"'), ExitCode::io, {}};
  EXPECT_LE(launch::encode(line).size(), 4096U);  // PIPE_BUF of Linux
}

TEST(RankLine, what_is_not_ours_is_left_alone) {
  for (const char* text :
       {"", "hello", "@furrow", "@furrow {", "@furrow []", "@furrow {\"kind\":\"x\",\"rank\":0}",
        "@furrow {\"kind\":\"note\"}", "@furrow {\"kind\":\"progress\",\"rank\":0,\"phase\":\"a\",\"values\":[1]}"})
    EXPECT_FALSE(launch::decode(text)) << text;
}

TEST(Supervisor, is_missed_by_ranks_on_its_machine_when_it_is_gone) {
  const auto lives = [](const std::string& name) {
    setenv(launch::kSupervisedVariable, name.c_str(), 1);
    const bool lives = launch::supervisor_lives();
    unsetenv(launch::kSupervisedVariable);
    return lives;
  };
  const std::string own = launch::supervisor_name(), host = own.substr(0, own.rfind(':') + 1);
  EXPECT_TRUE(lives(own));
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(lives(host + std::to_string(child)));
  EXPECT_TRUE(lives("another-" + host + std::to_string(child))) << "who can tell from here";
  EXPECT_TRUE(lives("1"));
  EXPECT_TRUE(launch::supervisor_lives()) << "nobody was named";
}

TEST(LauncherText, names_the_rank_that_died) {
  launch::LauncherText text;
  for (const char* line :
       {"--------------------------------------------------------------------------",
        "mpirun noticed that process rank 2 with PID 0 on node the-host exited on signal 9 (Killed).",
        "mpirun noticed that process rank 1 with PID 0 on node the-host exited on signal 15 (Terminated)."})
    text.add(line);
  ASSERT_TRUE(text.lost());
  EXPECT_EQ(text.lost()->rank, 2);
  EXPECT_EQ(text.lost()->signal, 9);
  EXPECT_EQ(text.words(), "");
}

TEST(LauncherText, joins_a_sentence_that_the_launcher_breaks) {
  launch::LauncherText text;
  for (const char* line :
       {"--------------------------------------------------------------------------",
        "prterun noticed that process rank 1 with PID 22546 on node the-host exited on", "signal 9 (Killed).",
        "--------------------------------------------------------------------------", "It went on."})
    text.add(line);
  ASSERT_TRUE(text.lost());
  EXPECT_EQ(text.lost()->rank, 1);
  EXPECT_EQ(text.lost()->signal, 9);
  EXPECT_EQ(text.words(), "It went on.");
}

TEST(LauncherText, finds_the_precondition_that_a_rank_reports) {
  launch::LauncherText text;
  EXPECT_EQ(text.fault(), "");
  text.add("a.cpp:7: step: precondition failed: dt > 0.0 [dt = 0]");
  text.add("[host:7] *** Process received signal ***");
  EXPECT_EQ(text.fault(), "a.cpp:7: step: precondition failed: dt > 0.0 [dt = 0]");
}

TEST(LauncherText, keeps_what_else_was_said_in_one_line) {
  launch::LauncherText text;
  for (const char* line :
       {"-----------------------------", "There are not enough slots available", "  in the system  ", ""})
    text.add(line);
  EXPECT_FALSE(text.lost());
  EXPECT_EQ(text.words(), "There are not enough slots available in the system");
}

TEST(LauncherText, passes_over_what_the_launcher_logs_of_itself_unless_there_is_nothing_else) {
  launch::LauncherText text;
  const std::string log = "[host:1] ORTE_ERROR_LOG: Data unpack would read past end of buffer in show_help.c";
  text.add(log);
  EXPECT_EQ(text.words(), log);
  text.add("A requested component was not found.");
  EXPECT_EQ(text.words(), "A requested component was not found.");
  launch::LauncherText aborted;
  aborted.add("[host:7] *** An error occurred in MPI_Init_thread");
  aborted.add({"\0*** on a NULL communicator", 27});  // Open MPI 5
  aborted.add("[host:7] Local abort before MPI_INIT completed completed successfully");
  aborted.add("A requested component was not found.");
  EXPECT_EQ(aborted.words(), "A requested component was not found.");
}

TEST(LauncherText, the_usual_paragraph_follows_what_says_more) {
  launch::LauncherText text;
  for (const char* line :
       {"------------", "It looks like MPI_INIT failed for some reason; there are many.", "Not found (-13)",
        "------------", "------------", "A requested component was not found.", "------------"})
    text.add(line);
  EXPECT_TRUE(text.words().starts_with("A requested component was not found. It looks like MPI_INIT failed"));
}

TEST(Progress, tells_time_pull_sinkage_speed_and_what_is_left) {
  EXPECT_EQ(launch::progress_text({"running", 0.25, 0.5, 2.0, 1432.5, 0.0312, 1.4, 83.0}),
            "t 0.500 of 2 s   1:23 left   pull 1432 N   sinkage 31.2 mm   1.40 m/s");
  EXPECT_EQ(launch::progress_text({"running", 0.0001, 0.0, 2.0, 0.0, 0.0, 0.0, 9e9}),
            "t 0.000 of 2 s   pull 0 N   sinkage 0 mm   0 m/s");
  // A laboratory's wheel pulls with a few newtons and moves slowly.
  EXPECT_EQ(launch::progress_text({"running", 0.25, 0.5, 2.0, 2.534, 0.00712, 0.0141, -1.0}),
            "t 0.500 of 2 s   pull 2.53 N   sinkage 7.12 mm   0.0141 m/s");
  EXPECT_EQ(launch::progress_text({"running", 0.25, 0.5, 2.0, NAN, 0.00712, 1.4, 83.0, "gear 2"}),
            "t 0.500 of 2 s   1:23 left   sinkage 7.12 mm   1.40 m/s   gear 2");
  EXPECT_EQ(launch::progress_text({"settling the bed", 0.42, 0.0, 1.5, 0.0, 0.0, 0.0, -1.0}), "settling the bed 42 %");
  EXPECT_EQ(launch::progress_text({"settling the bed", 0.42, 0.0, 1.5, 0.0, 0.0, 0.0, 65.0}),
            "settling the bed 42 %   1:05 left");
}

TEST(Progress, share_is_read_back_from_a_line_of_a_log) {
  EXPECT_DOUBLE_EQ(launch::share_in("furrow: t 0.500 of 2 s   pull 1432 N"), 0.25);
  for (const char* other : {"furrow: settling the bed 42 %", "t 0.5 of 2 s", "furrow: t 0.5 of 0 s", ""})
    EXPECT_TRUE(std::isnan(launch::share_in(other))) << other;
}

TEST(Progress, time_left_of_a_phase_is_its_time_until_now_scaled) {
  launch::PhaseClock clock;
  EXPECT_EQ(clock.time_left("settling", 0.2, 100.0), -1.0) << "nothing is done yet";
  EXPECT_DOUBLE_EQ(clock.time_left("settling", 0.4, 110.0), 30.0);
  EXPECT_EQ(clock.time_left("joining", 0.4, 120.0), -1.0) << "another phase begins";
  EXPECT_DOUBLE_EQ(clock.time_left("joining", 0.7, 123.0), 3.0);
}

}  // namespace
}  // namespace furrow
