// FURROW_ASSERT with assertions on in every build. assert_off_test.cpp is its counterpart.
#ifdef NDEBUG
#undef NDEBUG
#endif
#include "protocol/core/assert.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace furrow {
namespace {

double inverse(double value) {
  FURROW_ASSERT(value != 0.0);
  return 1.0 / value;
}

int entry(const std::vector<int>& values, int index) {
  FURROW_ASSERT(index >= 0 && index < static_cast<int>(values.size()), index, values.size());
  return values[index];
}

TEST(Assert, a_condition_that_holds_is_silent_and_evaluated_once) {
  int calls = 0;
  FURROW_ASSERT(++calls == 1, calls);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(entry({4, 5, 6}, 2), 6);
}

TEST(AssertDeathTest, a_condition_that_does_not_hold_ends_the_program_with_place_condition_and_values) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(entry({4, 5, 6}, 7),
               "assert_test.cpp:[0-9]+: entry: precondition failed: .*index < .*values.size.*"
               "\\[index, values.size\\(\\) = 7, 3\\]");
}

TEST(AssertDeathTest, without_values_the_message_ends_with_the_condition) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(inverse(0.0), "inverse: precondition failed: value != 0.0\n");
}

TEST(Assert, values_are_printed_in_full_and_what_no_stream_takes_is_a_mark) {
  struct Opaque {};
  EXPECT_EQ(detail::values_text(), "");
  EXPECT_EQ(detail::values_text(0.1, "grain", 17), "0.10000000000000001, grain, 17");
  EXPECT_EQ(detail::values_text(Opaque{}, 1), "…, 1");
}

}  // namespace
}  // namespace furrow
