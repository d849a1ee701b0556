// The energy from late forces, judged with invented works.
#include "nodes/output/lag_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace furrow::output {
namespace {

constexpr double kRadius = 0.4, kLoad = 5000.0;  // m, N

WheelRow row(double time, double ground, double rim, double passed) {
  WheelRow row;
  row.time = time;
  row.energy_error = ground;
  row.rim_energy_error = rim;
  row.passed_work = passed;
  return row;
}

TEST(LagWatch, judges_each_window_after_touch_down_by_the_worse_interface) {
  LagWatch watch(kRadius, 9.81);
  EXPECT_FALSE(watch.add(row(0.0, 50.0, 0.0, 0.0), kLoad, false)) << "in the air";
  EXPECT_FALSE(watch.add(row(0.1, 60.0, 0.0, 10.0), kLoad, true));
  EXPECT_FALSE(watch.add(row(0.2, 70.0, 0.0, 50.0), kLoad, false)) << "a window is a bounce of 0.21 s";
  const auto first = watch.add(row(0.4, 62.0, -30.0, 110.0), kLoad, true);
  ASSERT_TRUE(first);
  EXPECT_STREQ(first->interface, "rim");
  EXPECT_EQ(first->made, -30.0);
  EXPECT_EQ(first->passed, 100.0);
  EXPECT_NEAR(first->share, 0.3, 1e-15);
  EXPECT_EQ(first->from, 0.1);
  EXPECT_EQ(first->to, 0.4);
  const auto second = watch.add(row(0.8, 63.0, -30.0, 210.0), kLoad, true);
  ASSERT_TRUE(second);
  EXPECT_STREQ(second->interface, "ground");
  EXPECT_NEAR(second->share, 0.01, 1e-15);
}

TEST(LagWatch, a_standing_wheel_counts_as_if_a_thousandth_of_load_times_radius_passed) {
  EXPECT_NEAR(lag_share(1.0, 0.0, kLoad, kRadius), 0.5, 1e-15);
  EXPECT_NEAR(lag_share(-1.0, 4.0, kLoad, kRadius), 0.25, 1e-15);
  EXPECT_EQ(lag_share(NAN, INFINITY, kLoad, kRadius), INFINITY);
}

TEST(LagWatch, a_better_step_has_one_digit_and_is_smaller_in_proportion) {
  EXPECT_NEAR(better_step(1e-3, 0.1, INFINITY), 1e-4, 1e-18);
  EXPECT_NEAR(better_step(1e-3, 0.015, INFINITY), 5e-4, 1e-18);
  EXPECT_NEAR(better_step(4e-5, 0.04, INFINITY), 1e-5, 1e-18);
  EXPECT_NEAR(better_step(1e-3, INFINITY, INFINITY), 1e-4, 1e-18) << "a motion that ran away";
  EXPECT_NEAR(better_step(5e-4, 0.7, 8.64e-5), 8e-5, 1e-18) << "what the pair bears";
  EXPECT_NEAR(better_step(2e-4, 0.04, 5e-4), 5e-5, 1e-18) << "it bears more";
}

}  // namespace
}  // namespace furrow::output
