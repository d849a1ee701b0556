// The doorbell: rings are never missed, between threads and between processes.
#include "protocol/doorbell.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <new>
#include <thread>

#include "protocol/core/clock.hpp"

namespace furrow {
namespace {

constexpr double kLong = 20.0;  // s: nobody should sleep that long here

TEST(Doorbell, a_ring_before_the_sleep_ends_it_at_once) {
  Doorbell bell;
  const std::uint32_t heard = bell.count();
  bell.ring();
  const double begin = wall_clock();
  bell.sleep(heard, kLong);
  EXPECT_LT(wall_clock() - begin, 0.5 * kLong);
}

TEST(Doorbell, without_a_ring_it_sleeps_as_long_as_asked) {
  Doorbell bell;
  const double begin = wall_clock();
  bell.sleep(bell.count(), 0.02);
  EXPECT_GE(wall_clock() - begin, 0.019);
}

TEST(Doorbell, ten_thousand_rings_back_and_forth_wake_every_time) {
  Doorbell here, there;
  constexpr std::uint32_t kRounds = 10000;
  const double begin = wall_clock();
  const auto wait_for = [](Doorbell& bell, std::uint32_t count) {
    for (std::uint32_t heard; (heard = bell.count()) < count;) bell.sleep(heard, kLong);
  };
  std::thread other([&] {
    for (std::uint32_t n = 1; n <= kRounds; ++n) wait_for(there, n), here.ring();
  });
  for (std::uint32_t n = 1; n <= kRounds; ++n) there.ring(), wait_for(here, n);
  other.join();
  EXPECT_EQ(here.count(), kRounds);
  EXPECT_LT(wall_clock() - begin, kLong) << "a ring was missed";
}

TEST(Doorbell, wakes_another_process) {
  void* memory = mmap(nullptr, sizeof(Doorbell), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto* bell = new (memory) Doorbell;
  const pid_t child = fork();
  if (child == 0) {
    const double begin = wall_clock();
    while (bell->count() == 0) bell->sleep(0, kLong);
    _exit(wall_clock() - begin < 0.5 * kLong ? 0 : 1);
  }
  usleep(50000);
  bell->ring();
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  munmap(memory, sizeof(Doorbell));
}

}  // namespace
}  // namespace furrow
