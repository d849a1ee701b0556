// Progress of loops is reported at once, then a few times a second, however short their rounds are.
#include "protocol/core/paced_call.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>

namespace furrow {
namespace {

TEST(PacedCall, tells_at_once_and_then_now_and_then) {
  int calls = 0;
  const ProgressCall count = [&](const std::string&, double) { ++calls; };
  PacedCall tell(count);
  const double begin = wall_clock();
  for (int n = 0; n < 1000; ++n) tell("work", 0.5);
  EXPECT_GE(calls, 1);
  EXPECT_LE(calls, 1 + static_cast<int>((wall_clock() - begin) / PacedCall::kInterval) + 1);
  const int before = calls;
  usleep(static_cast<useconds_t>(1.1e6 * PacedCall::kInterval));
  tell("work", 0.6);
  EXPECT_EQ(calls, before + 1);
}

TEST(PacedCall, may_be_quiet_in_the_beginning) {
  int calls = 0;
  const ProgressCall count = [&](const std::string&, double) { ++calls; };
  PacedCall tell(count, 3600.0);
  for (int n = 0; n < 1000; ++n) tell("work", 0.5);
  EXPECT_EQ(calls, 0);
}

TEST(PacedCall, passes_on_the_wish_to_stop_and_minds_no_empty_call) {
  const ProgressCall stop = [](const std::string&, double) { throw std::runtime_error("stop"); };
  PacedCall tell(stop);
  EXPECT_THROW(tell("work", 0.0), std::runtime_error);
  const ProgressCall none;
  PacedCall silent(none);
  EXPECT_NO_THROW(silent("work", 0.0));
}

}  // namespace
}  // namespace furrow
