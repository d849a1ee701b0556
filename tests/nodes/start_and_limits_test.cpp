// Ranks that do not start, launchers that do not end, and limits of the system.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/end_watch.hpp"
#include "nodes/launch/limits.hpp"
#include "nodes/launch/signals.hpp"
#include "nodes/launch/start_watch.hpp"
#include "nodes/launch/supervisor_lines.hpp"
#include "nodes/launch/supervisor_text.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/core/assert.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

constexpr double kPatience = 0.05;  // s

void let_pass(double seconds) { usleep(static_cast<useconds_t>(1e6 * seconds)); }

TEST(StartWatch, ranks_that_do_not_begin_are_too_late) {
  launch::StartWatch watch(3, kPatience);
  EXPECT_FALSE(watch.too_late());
  watch.begun(0);
  EXPECT_EQ(watch.standing(), "1 of 3 ranks began");
  let_pass(2.0 * kPatience);
  EXPECT_TRUE(watch.too_late());
}

TEST(StartWatch, news_of_any_rank_gives_the_others_time_again) {
  launch::StartWatch watch(3, 10.0 * kPatience);
  for (int rank = 0; rank < 2; ++rank) {
    let_pass(6.0 * kPatience);
    watch.too_late();
    watch.begun(rank);
  }
  EXPECT_FALSE(watch.too_late());
}

TEST(StartWatch, reading_may_take_as_long_as_it_takes) {
  launch::StartWatch watch(2, kPatience);
  for (int rank = 0; rank < 2; ++rank) watch.begun(rank);
  watch.read(0);
  let_pass(2.0 * kPatience);
  EXPECT_FALSE(watch.too_late());
  watch.read(1);
  EXPECT_EQ(watch.standing(), "all 2 ranks began, but MPI connected none of 2 ranks");
  let_pass(2.0 * kPatience);
  EXPECT_TRUE(watch.too_late());
}

TEST(StartWatch, who_has_started_is_watched_no_more) {
  launch::StartWatch watch(1, kPatience);
  watch.begun(0), watch.read(0), watch.started(0);
  let_pass(2.0 * kPatience);
  EXPECT_FALSE(watch.too_late());
  EXPECT_TRUE(watch.all_started());
  EXPECT_EQ(watch.standing(), "all 1 ranks began and MPI connected them, but not all of it");
  EXPECT_EQ(watch.count(), 1U);
}

TEST(StartPatience, is_read_from_the_environment) {
  unsetenv("FURROW_START_TIMEOUT");
  EXPECT_EQ(launch::start_patience(), 120.0);
  setenv("FURROW_START_TIMEOUT", "7.5", 1);
  EXPECT_EQ(launch::start_patience(), 7.5);
  for (const char* wrong : {"soon", "0", "-1", "nan", "inf", "5 s"}) {
    setenv("FURROW_START_TIMEOUT", wrong, 1);
    EXPECT_THROW(launch::start_patience(), Error) << wrong;
  }
  unsetenv("FURROW_START_TIMEOUT");
}

TEST(EndWatch, a_launcher_has_a_while_to_end_once_all_its_ranks_have) {
  launch::EndWatch watch(2, kPatience, 1e3);
  watch.ended(0, ExitCode::done);
  let_pass(2.0 * kPatience);
  EXPECT_FALSE(watch.too_late(getpid()));
  watch.ended(1, ExitCode::done);
  EXPECT_FALSE(watch.too_late(getpid()));
  let_pass(2.0 * kPatience);
  EXPECT_TRUE(watch.too_late(getpid()));
}

TEST(EndWatch, after_a_failure_ranks_and_launcher_have_a_while_to_end) {
  launch::EndWatch watch(2, 1e3, kPatience);
  watch.failed();
  EXPECT_FALSE(watch.too_late(getpid()));
  let_pass(2.0 * kPatience);
  EXPECT_TRUE(watch.too_late(getpid()));
}

TEST(EndWatch, knows_the_first_code_that_is_none_of_success) {
  launch::EndWatch watch(3, kPatience, kPatience);
  watch.ended(0, ExitCode::done);
  EXPECT_EQ(watch.code(), ExitCode::done);
  watch.ended(2, ExitCode::physics);
  watch.ended(1, ExitCode::stopped);
  EXPECT_EQ(watch.code(), ExitCode::stopped);
}

/// A process with a child that ends and, on request, one that stays alive; it waits for neither.
class Launcher {
 public:
  explicit Launcher(bool one_lives) : process_(fork()) {
    if (process_ != 0) return;
    if (fork() == 0) _exit(0);
    if (one_lives && fork() == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      pause();
    }
    pause();
  }
  ~Launcher() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  pid_t process() const { return process_; }

 private:
  pid_t process_;
};

TEST(EndWatch, a_launcher_that_takes_no_notice_of_the_end_of_its_ranks_hangs) {
  for (const bool one_lives : {false, true}) {
    const Launcher launcher(one_lives);
    launch::EndWatch watch(2, kPatience, 1e3);
    bool late = false;
    for (int poll = 0; poll < 40 && !late; ++poll) {
      late = watch.too_late(launcher.process());
      let_pass(0.5 * kPatience);
    }
    EXPECT_EQ(late, !one_lives);
  }
}

TEST(RankLine, the_stages_of_a_rank_come_through) {
  using Kind = launch::RankLine::Kind;
  for (const auto kind : {Kind::begun, Kind::read, Kind::started, Kind::ended}) {
    const auto line = launch::decode(launch::encode({kind, 2, {}, ExitCode::stopped, {}}));
    ASSERT_TRUE(line);
    EXPECT_EQ(line->kind, kind);
    EXPECT_EQ(line->code, kind == Kind::ended ? ExitCode::stopped : ExitCode::done);
  }
}

TEST(LauncherText, a_line_without_end_does_not_take_the_stack) {
  launch::LauncherText text;
  text.add("process rank " + std::string(10000000, '1'));
  EXPECT_FALSE(text.lost());
}

TEST(Cause, of_a_death_by_the_limit_of_processor_time_is_that_limit) {
  bool certain = false;
  EXPECT_TRUE(holds(launch::cause_of(SIGXCPU, 0.0, certain), "ulimit -t"));
  EXPECT_TRUE(certain);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_CPU, &before), 0);
  if (before.rlim_cur != RLIM_INFINITY) GTEST_SKIP() << "this test runs under a limit itself";
  EXPECT_TRUE(holds(launch::cause_of(SIGKILL, 1e6, certain), "memory"));
  EXPECT_FALSE(certain);
  rlimit limited = before;
  limited.rlim_cur = 100000;
  ASSERT_EQ(setrlimit(RLIMIT_CPU, &limited), 0);
  EXPECT_TRUE(holds(launch::cause_of(SIGKILL, 1e6, certain), "100000 s of processor time (ulimit -t)"));
  EXPECT_TRUE(certain);
  EXPECT_TRUE(holds(launch::cause_of(SIGKILL, 10.0, certain), "memory"));
  EXPECT_FALSE(certain);
  setrlimit(RLIMIT_CPU, &before);
  EXPECT_EQ(launch::cause_of(SIGSEGV, 0.0, certain), "");
}

TEST(ForgetLauncher, takes_a_launchers_variables_and_leaves_the_users) {
  setenv("PMIX_RANK", "3", 1);
  setenv("PMIX_MCA_gds", "hash", 1);
  setenv("OMPI_MCA_ess", "pmi", 1);
  setenv("OMPI_MCA_btl", "^openib", 1);
  launch::forget_launcher();
  EXPECT_EQ(std::getenv("PMIX_RANK"), nullptr);
  EXPECT_EQ(std::getenv("OMPI_MCA_ess"), nullptr);
  EXPECT_STREQ(std::getenv("PMIX_MCA_gds"), "hash");
  EXPECT_STREQ(std::getenv("OMPI_MCA_btl"), "^openib");
  unsetenv("PMIX_MCA_gds"), unsetenv("OMPI_MCA_btl");
}

TEST(OutOfMemory, says_what_is_needed_and_what_there_is) {
  const Error error = scenario::out_of_memory(1.2e12);
  EXPECT_EQ(error.code(), ExitCode::limit);
  EXPECT_TRUE(holds(error.what(), "out of memory: needs about 1200"));
  EXPECT_TRUE(holds(error.what(), ", limit "));
}

TEST(NoThreadDeathTest, an_end_by_openmp_is_told_with_the_code_of_limits) {
  const auto end = [](int status) {
    std::atexit([] { std::fputs("ended slowly\n", stderr); });
    launch::end_where_no_thread_starts("no room for threads\n");
    std::exit(status);
  };
  EXPECT_EXIT(end(EXIT_FAILURE), ::testing::ExitedWithCode(6), "^no room for threads\n$");
  EXPECT_EXIT(end(3), ::testing::ExitedWithCode(3), "^ended slowly\n$");
}

TEST(AbortDeathTest, a_precondition_that_does_not_hold_has_the_code_of_faults) {
  const auto misuse = [](int threads) {
    launch::end_on_abort();
    FURROW_ASSERT(threads > 0, threads);
  };
  EXPECT_EXIT(misuse(0), ::testing::ExitedWithCode(70),
              "precondition failed: threads > 0 \\[threads = 0\\]\nfurrow: error: fault of the program, in the line");
}

TEST(RequireMemory, refuses_what_surely_does_not_fit) {
  scenario::Scenario scenario;
  scenario.file = "large.json";
  scenario.memory.terrain = 1e9;
  EXPECT_NO_THROW(scenario::require_memory(scenario));
  scenario.memory.terrain = 1e18;
  const std::string told = refusal(ExitCode::limit, [&] { scenario::require_memory(scenario); });
  EXPECT_EQ(told.find("large.json: out of memory: the terrain needs about 1000000000.0 GB, limit"), 0U) << told;
}

TEST(ShellPath, a_name_that_begins_with_a_hyphen_is_no_option) {
  EXPECT_EQ(scenario::shell_path("-out"), "./-out");
  EXPECT_EQ(scenario::shell_path("a b"), "'a b'");
  EXPECT_EQ(scenario::shell_path("results/x-001"), "results/x-001");
}

}  // namespace
}  // namespace furrow
