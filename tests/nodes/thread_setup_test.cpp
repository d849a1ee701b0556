// Assignment of cores: the plan is a pure function of the machine; applying it is checked on this machine.
#include "nodes/launch/thread_setup.hpp"
#include "nodes/ranks/thread_trial.hpp"
#include "nodes/scenario/terrain_threads.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>
#include <string>
#include <thread>

namespace furrow {
namespace {

/// Rig, tires and one terrain that may all use the cores 0 … n − 1 of a machine with n cores.
launch::HostView machine(int cores, int tires = 1) {
  launch::HostView host;
  host.machine_cores = cores;
  std::vector<int> all(static_cast<std::size_t>(cores));
  std::iota(all.begin(), all.end(), 0);
  host.nodes.push_back({{Role::rig, 0}, all, false});
  for (int k = 0; k < tires; ++k) host.nodes.push_back({{Role::tire, k}, all, false});
  host.nodes.push_back({{Role::terrain, 0}, all, false});
  return host;
}

std::vector<launch::ThreadPlan> plan_all(const launch::HostView& host, int terrain_threads = 0) {
  std::vector<launch::ThreadPlan> plans;
  for (std::size_t i = 0; i < host.nodes.size(); ++i) plans.push_back(launch::plan_threads(host, i, terrain_threads));
  return plans;
}

std::vector<int> threads_of(const std::vector<launch::ThreadPlan>& plans) {
  std::vector<int> threads;
  for (const launch::ThreadPlan& plan : plans) threads.push_back(plan.threads);
  return threads;
}

/// No two computing threads share a core; the rig's may be shared.
void expect_disjoint(const std::vector<launch::ThreadPlan>& plans) {
  std::set<int> used;
  for (std::size_t i = 1; i < plans.size(); ++i) {
    EXPECT_TRUE(plans[i].disjoint);
    EXPECT_EQ(static_cast<int>(plans[i].cores.size()), plans[i].threads);
    for (const int core : plans[i].cores) EXPECT_TRUE(used.insert(core).second) << "core " << core << " twice";
  }
}

TEST(ThreadPlan, two_cores_are_left_to_the_system) {
  const auto plans = plan_all(machine(2));
  EXPECT_EQ(threads_of(plans), (std::vector<int>{1, 1, 1}));
  for (const launch::ThreadPlan& plan : plans) {
    EXPECT_FALSE(plan.disjoint);
    EXPECT_TRUE(plan.cores.empty());
    EXPECT_TRUE(plan.note.empty());
  }
}

// Measured on two cores with six ranks: faster with many grains, slower with few.
TEST(ThreadPlan, a_terrain_of_many_grains_shares_the_cores_of_many_tires) {
  auto host = machine(2, 4);
  host.grains = 67'000;
  EXPECT_EQ(plan_all(host).back().threads, 1);
  host.grains = 1'140'000;
  EXPECT_EQ(plan_all(host).back().threads, 2);
  EXPECT_EQ(plan_all(host, 1).back().threads, 1);  // the user's choice
  host = machine(2, 1);
  host.grains = 1'140'000;
  EXPECT_EQ(plan_all(host).back().threads, 1);  // the tire leaves it half
  host = machine(16, 4);
  host.grains = 1'140'000;
  EXPECT_EQ(plan_all(host).back().threads, 11);  // the others leave enough
}

TEST(ThreadPlan, a_terrain_may_try_the_cores_of_others_where_these_leave_at_most_half) {
  auto host = machine(2);
  EXPECT_EQ(plan_all(host).back().other, 0);  // nothing is known of its grains
  host.grains = 3'000;
  EXPECT_EQ(plan_all(host).back().other, 0);  // too few for two threads
  host.grains = 38'000;
  EXPECT_EQ(plan_all(host).back().other, 2);
  EXPECT_EQ(plan_all(host).front().other, 0);
  EXPECT_EQ(plan_all(host, 1).back().other, 0);  // the user's choice
  host = machine(2, 4);
  host.grains = 1'140'000;
  EXPECT_EQ(plan_all(host).back().other, 1);  // it has all cores to begin with
  host = machine(16);
  host.grains = 1'140'000;
  EXPECT_EQ(plan_all(host).back().other, 0);
}

/// Steps on until the trial has ended at which a step takes so long with one and with two threads. @returns the choice
int tried(ranks::ThreadTrial& threads, double one, double two) {
  for (int k = 0; k < 7000; ++k) threads.step_took(threads.now() == 1 ? one : two);
  return threads.now();
}

TEST(ThreadTrial, the_faster_number_is_kept_and_changes_where_the_other_becomes_faster) {
  ranks::ThreadTrial threads(1, 2);
  EXPECT_EQ(tried(threads, 1.0, 0.99), 1);  // it gains too little
  EXPECT_EQ(tried(threads, 1.0, 0.8), 2);
  EXPECT_EQ(tried(threads, 1.0, 1.02), 2);
  EXPECT_EQ(tried(threads, 1.0, 1.5), 1);
}

TEST(ThreadTrial, a_slow_block_does_not_decide) {
  ranks::ThreadTrial threads(1, 2);
  bool slow = true;  // the first block with two threads
  for (int k = 0; k < 3000; ++k) {
    const bool two = threads.now() == 2;
    threads.step_took(two && slow ? 5.0 : two ? 0.8 : 1.0);
    if (slow && !two && k > 900) slow = false;
  }
  EXPECT_EQ(threads.now(), 2);
}

TEST(ThreadTrial, nothing_is_tried_where_there_is_no_choice) {
  ranks::ThreadTrial threads(3);
  for (int k = 0; k < 3000; ++k) {
    threads.step_took(1.0);
    ASSERT_EQ(threads.now(), 3);
  }
}

TEST(ThreadPlan, four_cores_leave_three_to_the_terrain_and_the_rig_sits_with_the_tire) {
  const auto plans = plan_all(machine(4));
  EXPECT_EQ(threads_of(plans), (std::vector<int>{1, 1, 3}));
  expect_disjoint(plans);
  EXPECT_EQ(plans[0].cores, plans[1].cores);
}

TEST(ThreadPlan, many_cores_give_the_rig_one_of_its_own) {
  const auto plans = plan_all(machine(16, 4));
  EXPECT_EQ(threads_of(plans), (std::vector<int>{1, 1, 1, 1, 1, 11}));
  expect_disjoint(plans);
  for (std::size_t i = 1; i < plans.size(); ++i) EXPECT_NE(plans[i].cores.front(), plans[0].cores.front());
}

TEST(ThreadPlan, four_tires_on_two_cores_are_left_to_the_system) {
  const auto plans = plan_all(machine(2, 4));
  EXPECT_EQ(threads_of(plans), (std::vector<int>{1, 1, 1, 1, 1, 1}));
  for (const launch::ThreadPlan& plan : plans) EXPECT_FALSE(plan.disjoint);
}

TEST(ThreadPlan, the_terrain_takes_no_more_than_pays_by_itself) {
  EXPECT_EQ(plan_all(machine(128)).back().threads, scenario::kMaxAutoThreads);
  EXPECT_EQ(plan_all(machine(128), 100).back().threads, 100);
}

TEST(ThreadPlan, what_the_user_wants_is_done_even_where_it_does_not_fit) {
  const auto plans = plan_all(machine(2), 6);
  EXPECT_EQ(plans.back().threads, 6);
  EXPECT_FALSE(plans.back().disjoint);
  EXPECT_TRUE(holds(plans.back().note, "terrain runs 6 threads on 2 cores"));
}

TEST(ThreadPlan, a_busy_machine_or_a_limited_container_is_not_bound) {
  launch::HostView host = machine(8);
  host.load = 5.0;
  EXPECT_FALSE(plan_all(host).back().disjoint);
  host.load = 0.2;
  expect_disjoint(plan_all(host));
  host.cpu_limit = 2.0;
  EXPECT_FALSE(plan_all(host).back().disjoint);
  EXPECT_EQ(plan_all(host).back().threads, 1);
}

TEST(ThreadPlan, ranks_that_the_launcher_bound_stay_within_their_cores) {
  launch::HostView host = machine(8);
  host.nodes[0].cores = {0};
  host.nodes[1].cores = {1, 2};
  host.nodes[2].cores = {4, 5, 6, 7};
  const auto plans = plan_all(host);
  EXPECT_EQ(threads_of(plans), (std::vector<int>{1, 1, 4}));
  expect_disjoint(plans);
  EXPECT_EQ(plans[2].cores, (std::vector<int>{4, 5, 6, 7}));
  for (const launch::ThreadPlan& plan : plans) EXPECT_TRUE(plan.note.empty()) << plan.note;
}

TEST(ThreadPlan, a_terrain_pinned_to_one_core_is_warned_about) {
  launch::HostView host = machine(8);
  for (int i = 0; i < 3; ++i) host.nodes[static_cast<std::size_t>(i)].cores = {i};
  const auto plans = plan_all(host, 4);
  EXPECT_EQ(plans[2].threads, 4);
  EXPECT_TRUE(holds(plans[2].note, "terrain is pinned to core 2 of 8 while 4 threads are wanted"));
  EXPECT_TRUE(holds(plans[2].note, "--bind-to none"));
  EXPECT_TRUE(plans[1].note.empty());
  EXPECT_EQ(plan_all(host)[2].threads, 1);
  EXPECT_FALSE(plan_all(host)[2].note.empty());
}

TEST(ThreadPlan, a_run_on_the_one_core_that_it_was_started_on_hears_nothing_of_the_launcher) {
  launch::HostView host = machine(8);
  for (HostNode& node : host.nodes) node.cores = {3};
  for (const launch::ThreadPlan& plan : plan_all(host)) EXPECT_EQ(plan.note, "");
  EXPECT_TRUE(holds(plan_all(host, 4)[2].note, "terrain runs 4 threads on 1 cores; fewer are faster"));
  host.nodes = {host.nodes.back()};  // alone on its machine: srun gave it this core
  EXPECT_TRUE(holds(plan_all(host)[0].note, "--cpus-per-task"));
}

// In a separate thread: OpenMP gives it its own team, and this test's settings end with it.
TEST(Apply, every_thread_flushes_denormals_and_is_bound) {
  std::thread([] {
    const std::vector<int> cores = allowed_cores();
    launch::ThreadPlan plan;
    plan.threads = static_cast<int>(std::min<std::size_t>(cores.size(), 3));
    plan.cores.assign(cores.begin(), cores.begin() + plan.threads);
    launch::apply(plan);
    EXPECT_EQ(omp_get_max_threads(), plan.threads);
    std::vector<int> core(static_cast<std::size_t>(plan.threads), -1), flushed(core);
#pragma omp parallel
    {
      const auto me = static_cast<std::size_t>(omp_get_thread_num());
      cpu_set_t set;
      if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) == 1)
        for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
          if (CPU_ISSET(cpu, &set)) core[me] = cpu;
      volatile double tiny = 1e-300;
      flushed[me] = tiny * 1e-20 == 0.0;
    }
    EXPECT_EQ(core, plan.cores);
    EXPECT_EQ(flushed, std::vector<int>(flushed.size(), 1));
  }).join();
}

TEST(Apply, a_plan_without_cores_leaves_the_process_where_it_may_run) {
  std::thread([] {
    cpu_set_t before, after;
    sched_getaffinity(0, sizeof before, &before);
    launch::apply({2, {}, false, {}});
    sched_getaffinity(0, sizeof after, &after);
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
  }).join();
}

// The next test runs it in its own process.
TEST(WaitPassively, DISABLED_child) {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  launch::wait_passively(argv.data());
  std::printf("<%s|%d>\n", std::getenv("OMP_WAIT_POLICY"), static_cast<int>(words.size()));
}

TEST(WaitPassively, starts_the_program_anew_once_with_the_same_arguments) {
  const auto said = [](const std::string& environment) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::string command =
        "env " + environment + " '" + self + "' --gtest_filter=*child --gtest_also_run_disabled_tests 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    char text[4096] = {};
    const std::size_t length = fread(text, 1, sizeof text - 1, pipe);
    EXPECT_EQ(pclose(pipe), 0);
    return std::string(text, length);
  };
  const std::string anew = said("-u OMP_WAIT_POLICY"), kept = said("OMP_WAIT_POLICY=active");
  EXPECT_TRUE(holds(anew, "<passive|3>"));
  EXPECT_TRUE(holds(kept, "<active|3>"));
}

}  // namespace
}  // namespace furrow
