// A run ends before a wall: wheels near each wall.
#include "nodes/ranks/wall_watch.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

using output::EndReason;
using ranks::WallWatch, ranks::WheelPlace;

constexpr double kRadius = 0.5, kWidth = 0.3, kStop = 1.0;
const terrain::TerrainBounds kBin{10.0, 3.0};

WheelPlace wheel(double x, double y, const Vec3& heading = Vec3::UnitX()) {
  return {Vec3(x, y, 0.5), heading, kRadius, kWidth};
}

std::optional<EndReason> seen(const WheelPlace& start, const WheelPlace& now, double stop = kStop) {
  return WallWatch(kBin, stop, std::vector{start}).near(std::vector{now});
}

TEST(WallWatch, sees_the_end_wall_ahead_of_the_tread) {
  EXPECT_EQ(seen(wheel(2, 0), wheel(8.49, 0)), std::nullopt);
  EXPECT_EQ(seen(wheel(2, 0), wheel(8.51, 0)), EndReason::end_wall);
  EXPECT_EQ(seen(wheel(2, 0), wheel(8.51, 0), 0.9), std::nullopt);
  EXPECT_EQ(seen(wheel(8, 0), wheel(1.49, 0)), EndReason::end_wall);  // or behind it
}

TEST(WallWatch, lets_a_wheel_that_starts_near_a_wall_come_half_of_the_way) {
  EXPECT_EQ(seen(wheel(0.52, 0), wheel(0.515, 0)), std::nullopt);
  EXPECT_EQ(seen(wheel(0.52, 0), wheel(0.505, 0)), EndReason::end_wall);
}

TEST(WallWatch, sees_side_walls_by_the_width_and_the_turn_of_the_wheel) {
  EXPECT_EQ(seen(wheel(2, 0), wheel(5, 1.19)), std::nullopt);
  EXPECT_EQ(seen(wheel(2, 0), wheel(5, 1.21)), EndReason::side_wall);
  EXPECT_EQ(seen(wheel(2, 0), wheel(5, -1.21)), EndReason::side_wall);
  EXPECT_EQ(seen(wheel(2, 0), wheel(5, 0.9, Vec3::UnitY())), EndReason::side_wall);
  EXPECT_EQ(seen(wheel(2, 0), wheel(5, 0.84, Vec3::UnitY())), std::nullopt);
}

}  // namespace
}  // namespace furrow
