// Paths against the shapes that they represent, and the tracks of the double lane change.
#include "vehicle/driver/path.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vehicle/driver/lane_change.hpp"
#include "vehicle/driver/path_shapes.hpp"

using namespace furrow;
using namespace furrow::vehicle;
using std::numbers::pi;

namespace {

constexpr double kVehicleWidth = 2.0;

Path path_of(const PathShape& shape) { return make_path({shape, 0.0, 0.0, 0.0, {}}, kVehicleWidth); }

}  // namespace

TEST(Path, of_a_circle_stays_on_it_and_has_its_length) {
  for (const char* turn : {"left", "right"}) {
    const double radius = 20.0, side = std::string(turn) == "left" ? 1.0 : -1.0;
    const Path path = path_of(CirclePath{5.0, radius, 450.0, turn});
    EXPECT_NEAR(path.distance(path.end()), 5.0 + 2.5 * pi * radius, 1e-8);
    const Vec2 centre(5.0, side * radius);
    for (int piece = 1; piece <= path.end().piece; ++piece) {
      for (const double u : {0.0, 0.2, 0.5, 0.9}) {
        const PathPoint point = path.at({piece, u});
        const Vec2 r = point.position - centre;
        EXPECT_NEAR(r.norm(), radius, 1e-9 * radius);
        EXPECT_NEAR(r.dot(point.direction), 0.0, 1e-6 * radius);
      }
    }
    EXPECT_NEAR((path.at(path.end()).position - (centre + Vec2(radius, 0.0))).norm(), 0.0, 1e-9);
  }
}

TEST(Path, is_placed_by_its_origin_and_heading) {
  const Path path = make_path({StraightPath{10.0}, 1.0, 2.0, 90.0, {}}, kVehicleWidth);
  EXPECT_NEAR((path.at({0, 0.5}).position - Vec2(1.0, 7.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((path.at({0, 0.5}).direction - Vec2(0.0, 1.0)).norm(), 0.0, 1e-12);
}

TEST(Path, goes_through_waypoints_with_a_continuous_direction) {
  const WaypointPath shape{{{0, 0}, {10, 1}, {18, 8}, {20, 20}, {35, 25}}};
  const Path path = path_of(shape);
  ASSERT_EQ(path.end().piece, 3);
  for (int i = 0; i < 5; ++i) {
    const PathPoint knot = i < 4 ? path.at({i, 0.0}) : path.at(path.end());
    const auto [x, y] = shape.points[static_cast<std::size_t>(i)];
    EXPECT_NEAR((knot.position - Vec2(x, y)).norm(), 0.0, 1e-12);
    if (i == 0 || i == 4) continue;
    EXPECT_NEAR((knot.direction - path.at({i - 1, 1.0}).direction).norm(), 0.0, 1e-12);
  }
}

TEST(Path, through_waypoints_of_a_circle_is_that_circle) {
  WaypointPath shape;
  for (int i = 0; i <= 20; ++i) shape.points.emplace_back(10.0 * std::sin(0.2 * i), 10.0 - 10.0 * std::cos(0.2 * i));
  const Path path = path_of(shape);
  for (int piece = 0; piece <= path.end().piece; ++piece)
    for (const double u : {0.25, 0.5, 0.8})
      EXPECT_NEAR((path.at({piece, u}).position - Vec2(0.0, 10.0)).norm(), 10.0, 1e-6);
  EXPECT_NEAR(path.distance(path.end()), 40.0, 1e-5);
}

TEST(Path, follows_to_the_nearest_place_and_never_back) {
  const Path path = path_of(CirclePath{0.0, 20.0, 180.0, "left"});
  PathPlace place;
  for (const double angle : {0.3, 1.0, 2.0}) {
    place = path.follow(place, Vec2(23.0 * std::sin(angle), 20.0 - 23.0 * std::cos(angle)));
    EXPECT_NEAR(path.distance(place), 20.0 * angle, 1e-6);
  }
  const PathPlace back = path.follow(place, Vec2(0.0, 0.0));
  EXPECT_EQ(back.piece, place.piece);
  EXPECT_EQ(back.fraction, place.fraction);
  EXPECT_TRUE(path.is_end(path.follow(place, Vec2(-1.0, 40.0))));
}

TEST(Path, looks_ahead_on_itself_and_beyond_its_end) {
  const Path path = path_of(StraightPath{10.0});
  EXPECT_NEAR((path.look_ahead({0, 0.2}, Vec2(2.0, 3.0), 5.0) - Vec2(6.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((path.look_ahead({0, 0.8}, Vec2(8.0, 3.0), 5.0) - Vec2(12.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((path.look_ahead(path.end(), Vec2(30.0, -3.0), 5.0) - Vec2(34.0, 0.0)).norm(), 0.0, 1e-9);
}

TEST(LaneChange, has_the_lengths_and_widths_of_the_standards) {
  const auto first = lanes_of("iso_3888_1", kVehicleWidth);
  EXPECT_DOUBLE_EQ(first[0].width, 2.45);
  EXPECT_DOUBLE_EQ(first[1].width, 2.65);
  EXPECT_DOUBLE_EQ(first[2].width, 2.85);
  EXPECT_DOUBLE_EQ(first[1].start, 45.0);
  EXPECT_DOUBLE_EQ(first[2].start, 95.0);
  EXPECT_DOUBLE_EQ(first[2].end, 125.0);
  const auto right = [](const Lane& lane) { return lane.centre - 0.5 * lane.width; };
  EXPECT_NEAR(right(first[1]) - right(first[0]), 3.5, 1e-12);
  EXPECT_NEAR(right(first[2]) - right(first[0]), 0.0, 1e-12);

  const auto second = lanes_of("iso_3888_2", kVehicleWidth);
  EXPECT_DOUBLE_EQ(second[0].width, 2.45);
  EXPECT_DOUBLE_EQ(second[1].width, 3.0);
  EXPECT_DOUBLE_EQ(second[2].width, 3.0);  // at least
  EXPECT_DOUBLE_EQ(second[1].start, 25.5);
  EXPECT_DOUBLE_EQ(second[2].start, 49.0);
  EXPECT_DOUBLE_EQ(second[2].end, 61.0);
  const auto left = [](const Lane& lane) { return lane.centre + 0.5 * lane.width; };
  EXPECT_NEAR(right(second[1]) - left(second[0]), 1.0, 1e-12);
  EXPECT_NEAR(left(second[2]) - left(second[0]), 0.0, 1e-12);
}

TEST(LaneChange, path_is_the_smoothstep_between_the_centre_lines) {
  const auto lanes = lanes_of("iso_3888_1", kVehicleWidth);
  const Path path = path_of(LaneChangePath{"iso_3888_1", 10.0, 5.0});
  PathPlace place;
  for (double x = 0.0; x <= 140.0; x += 0.37) {
    double y = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      if (x - 10.0 >= lanes[i].start) y = lanes[i].centre;
    for (std::size_t i = 0; i < 2; ++i) {
      const double t = (x - 10.0 - lanes[i].end) / (lanes[i + 1].start - lanes[i].end);
      if (t <= 0.0 || t >= 1.0) continue;
      const double h = lanes[i + 1].centre - lanes[i].centre;
      y = lanes[i].centre + h * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
    }
    place = path.follow(place, Vec2(x, y));
    EXPECT_NEAR((path.at(place).position - Vec2(x, y)).norm(), 0.0, 1e-5) << x;
  }
}
