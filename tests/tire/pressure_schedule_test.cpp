#include "tire/pressure_schedule.hpp"

#include <gtest/gtest.h>

namespace furrow::tire {
namespace {

TEST(PressureSchedule, is_linear_between_its_knots_and_constant_outside) {
  const PressureSchedule s{{{0.5, 2e5}, {1.0, 1e5}, {3.0, 3e5}}};
  EXPECT_EQ(s.at(-1.0), 2e5);
  EXPECT_EQ(s.at(0.5), 2e5);
  EXPECT_DOUBLE_EQ(s.at(0.6), 1.8e5);
  EXPECT_EQ(s.at(1.0), 1e5);
  EXPECT_DOUBLE_EQ(s.at(2.5), 2.5e5);
  EXPECT_EQ(s.at(3.0), 3e5);
  EXPECT_EQ(s.at(99.0), 3e5);
  EXPECT_EQ(s.lowest(), 1e5);
  EXPECT_EQ(s.highest(), 3e5);
  EXPECT_TRUE(s.varies());
}

TEST(PressureSchedule, of_one_knot_is_constant) {
  const PressureSchedule s{{{0.0, 2e5}}};
  EXPECT_EQ(s.at(-5.0), 2e5);
  EXPECT_EQ(s.at(5.0), 2e5);
  EXPECT_FALSE(s.varies());
  EXPECT_TRUE(PressureSchedule{}.empty());
}

}  // namespace
}  // namespace furrow::tire
