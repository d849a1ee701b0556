// Ranks under mpirun: order and contents, failures, lost ranks, and processor time while waiting. Starts mpirun itself.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace {

struct Outcome {
  int exit_code = -1;
  double wall_s = 0.0;
  std::string output;

  int count(const std::string& text) const {
    int found = 0;
    for (std::size_t at = output.find(text); at != std::string::npos; at = output.find(text, at + 1)) ++found;
    return found;
  }
  /// "name value" in the line of a rank.
  double value(const std::string& rank, const std::string& name) const {
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);)
      if (line.rfind(rank + ":", 0) == 0) {
        const std::size_t at = line.find(name + " ");
        if (at != std::string::npos) return std::atof(line.c_str() + at + name.size() + 1);
      }
    ADD_FAILURE() << "no " << name << " of " << rank << " in:\n" << output;
    return 0.0;
  }
};

Outcome start_once(const std::string& scene, int ranks, const std::string& environment) {
  const std::string command =
      environment + " OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout -k 5 50 " MPIRUN " -n " +
      std::to_string(ranks) + " --oversubscribe --bind-to none '" RANKS "' " + scene + " 2>&1 < /dev/null";
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  char piece[4096];
  while (const std::size_t length = fread(piece, 1, sizeof piece, pipe)) outcome.output.append(piece, length);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  // Open MPI 4.1's mpirun itself sometimes dies of a signal at its end, after it has reported the exit code of the
  // first rank that failed. This report is tested.
  const std::size_t crash = outcome.output.find("PMIx_server_finalize");
  const std::size_t told = outcome.output.find("Exit code:");
  if (crash != std::string::npos && told < crash) outcome.exit_code = std::atoi(outcome.output.c_str() + told + 10);
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

/// Open MPI 4.1's mpirun sometimes hangs at its end instead, after a rank has ended with a code other than 0
/// (nodes/launch/end_watch.hpp). Such a try is repeated once.
Outcome start(const std::string& scene, int ranks = 3, const std::string& environment = "") {
  constexpr int kTimedOut = 124, kKilled = 137;  // what `timeout` returns
  const Outcome outcome = start_once(scene, ranks, environment);
  const bool out_of_time = outcome.exit_code == kTimedOut || outcome.exit_code == kKilled;
  if (!out_of_time || outcome.count("Exit code:") == 0) return outcome;
  std::printf("%s: mpirun did not end\n%s", scene.c_str(), outcome.output.c_str());
  return start_once(scene, ranks, environment);
}

TEST(Mpi, a_thousand_steps_of_4000_vertices_arrive_in_order_and_whole) {
  const Outcome outcome = start("ping");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.count("1000 steps"), 3) << outcome.output;
  EXPECT_EQ(outcome.count("role communicator made"), 3) << outcome.output;
  std::printf("%s", outcome.output.c_str());
}

TEST(Mpi, a_failure_is_told_once_and_ends_all_ranks_with_its_code) {
  const Outcome outcome = start("one_fails");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_EQ(outcome.count("error: tire 0: no convergence at step 10"), 1) << outcome.output;
  EXPECT_EQ(outcome.count("rig left: tire 0 failed"), 1) << outcome.output;
  EXPECT_EQ(outcome.count("terrain left: tire 0 failed"), 1) << outcome.output;
  EXPECT_LT(outcome.wall_s, 15.0);
}

TEST(Mpi, a_wrong_number_of_ranks_is_the_same_error_on_each) {
  for (const int ranks : {2, 4}) {
    const Outcome outcome = start("ping", ranks);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_EQ(outcome.count("error: this scenario needs 3 ranks (1 rig, 1 tire(s), 1 terrain), but " +
                            std::to_string(ranks) + " were started"),
              ranks)
        << outcome.output;
  }
}

TEST(Mpi, a_stopped_rank_is_named_within_the_time_out) {
  const Outcome outcome = start("one_stops");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
  EXPECT_GE(outcome.count("waited 2 s for tire 0"), 1) << outcome.output;
  EXPECT_GE(outcome.count("tire 0 does not answer"), 1) << outcome.output;
  EXPECT_LT(outcome.wall_s, 20.0);
  std::printf("ended after %.1f s\n", outcome.wall_s);
}

TEST(Mpi, a_failure_ends_the_run_although_another_rank_is_stopped) {
  const Outcome outcome = start("one_fails_one_stops");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_LT(outcome.wall_s, 20.0);
}

TEST(Mpi, a_settling_terrain_keeps_those_alive_who_wait_for_it) {
  const Outcome outcome = start("settling");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.count("settled"), 3) << outcome.output;
}

TEST(Mpi, time_during_which_the_waiting_rank_itself_was_stopped_does_not_count) {
  const Outcome outcome = start("waiting_one_is_stopped");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.count("patient"), 3) << outcome.output;
}

// The stated goal is 10 % while a rank waits 95 % of 4 ms steps; the limits here leave room for a busy machine.
TEST(Mpi, a_waiting_rank_leaves_its_core_alone) {
  const Outcome outcome = start("waiting");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  std::printf("%s", outcome.output.c_str());
  for (const char* rank : {"rig", "tire 0"}) {
    EXPECT_LE(outcome.value(rank, "cpu_share"), 0.25);
    EXPECT_GE(outcome.value(rank, "wait_share"), 0.90);
    EXPECT_LE(outcome.value(rank, "wait_share"), 1.001);
  }
  EXPECT_LE(outcome.value("terrain", "wait_share"), 0.35);
}

/// The user's choice is kept. 66 ranks on two cores took 50 s to start if none yielded (start_of_ranks.csv).
TEST(Mpi, ranks_yield_while_they_are_set_up_and_not_in_steps) {
  const std::string variable = "OMPI_MCA_mpi_yield_when_idle=";
  const Outcome ours = start("yielding");
  ASSERT_EQ(ours.exit_code, 0) << ours.output;
  if (ours.count("unknown") > 0) GTEST_SKIP() << "this MPI does not tell";
  EXPECT_EQ(ours.count("begun with 1, yields in steps: no"), 3) << ours.output;
  const Outcome always = start("yielding", 3, variable + "1"), never = start("yielding", 3, variable + "0");
  EXPECT_EQ(always.count("begun with 1, yields in steps: yes"), 3) << always.output;
  EXPECT_EQ(never.count("begun with 0, yields in steps: no"), 3) << never.output;
}

TEST(Mpi, long_waits_cost_next_to_nothing) {
  const Outcome outcome = start("waiting_long");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* rank : {"rig", "tire 0"}) EXPECT_LE(outcome.value(rank, "cpu_share"), 0.10) << outcome.output;
}

// If processes may not read each other's memory, a message moves only while both ends are in MPI. Without flush the
// terrain would wait for a tire that computes: their steps would add up (`flush` in protocol/README.md).
TEST(Mpi, steps_overlap_even_where_senders_must_push) {
  const Outcome outcome = start("sender_leaves", 3, "OMPI_MCA_btl_vader_single_copy_mechanism=none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.count("nobody waited for one that computes"), 3) << outcome.output;
}

}  // namespace
