// Roads whose reference line turns: closed forms on a circle, the evaluator of ASAM, and the contact on such a road.
#include "terrain/rigid/road_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/ground_shape.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/terrain/ground_push.hpp"

namespace furrow::terrain {
namespace {

constexpr double kIncrement = 0.5;  // m

/// A line that turns to the left by `turn` at each of its points; u begins at 3 m.
RoadLine circle(double turn, int segments) {
  std::vector<double> headings;
  for (int k = 0; k < segments; ++k) headings.push_back(k * turn);
  return RoadLine({1.0, 2.0}, 3.0, kIncrement, headings);
}

/// The points lie on a circle; a place at the distance r from its centre, ψ beyond the middle of segment k, has
///   u = 3 m + increment (k + ½ + tan ψ/(2 tan(turn/2))),   v = r_i − r cos ψ, r_i the radius of the inner circle.
TEST(RoadLine, places_by_a_circle_are_those_of_its_polygon) {
  for (const double turn : {0.02, -0.05}) {
    const RoadLine line = circle(turn, 100);
    const double inner = 0.5 * kIncrement / std::tan(0.5 * std::abs(turn)), side = std::copysign(1.0, turn);
    const RoadLine::Vec2 centre(1.0 + 0.5 * kIncrement, 2.0 + side * inner);
    for (const int k : {1, 37, 98})
      for (const double share : {-0.49, -0.1, 0.0, 0.3, 0.5})
        for (const double v : {-3.0, 0.0, 2.5}) {
          const double psi = share * std::abs(turn), angle = (k + share) * turn;
          const double r = (inner - v) / std::cos(psi);
          const RoadLine::Place at =
              line.place({centre.x() + r * std::sin(std::abs(angle)), centre.y() - side * r * std::cos(angle)});
          const double u = 3.0 + kIncrement * (k + 0.5 + 0.5 * std::tan(psi) / std::tan(0.5 * std::abs(turn)));
          EXPECT_NEAR(at.u, u, 1e-10) << turn << " " << k << " " << share << " " << v;
          EXPECT_NEAR(at.v, side * v, 1e-10) << turn << " " << k << " " << share << " " << v;
        }
    EXPECT_NEAR(line.room(5, side), inner, 1e-9);
    EXPECT_TRUE(std::isinf(line.room(5, -side)));
    EXPECT_NEAR(line.most_curvature() * inner, 1.0, 1e-3);
  }
}

TEST(RoadLine, gradients_are_those_of_its_places) {
  std::vector<double> headings;
  for (int k = 0; k < 40; ++k) headings.push_back(0.4 * std::sin(0.3 * k));
  const RoadLine line({0.0, 0.0}, 0.0, kIncrement, headings);
  constexpr double kStep = 1e-6;
  for (double x = 0.1; x < 17.0; x += 0.37)
    for (const double y : {-0.6, 0.2, 0.9}) {
      const RoadLine::Vec2 at(x, y), dx(kStep, 0.0), dy(0.0, kStep);
      const RoadLine::Place here = line.place(at);
      if (line.place(at + dx).segment != line.place(at - dx).segment) continue;
      const RoadLine::Place east = line.place(at + dx), west = line.place(at - dx);
      const RoadLine::Place north = line.place(at + dy), south = line.place(at - dy);
      if (north.segment != south.segment) continue;
      EXPECT_NEAR(here.along.x(), (east.u - west.u) / (2.0 * kStep), 1e-7) << x << " " << y;
      EXPECT_NEAR(here.along.y(), (north.u - south.u) / (2.0 * kStep), 1e-7) << x << " " << y;
      EXPECT_NEAR(here.across.x(), (east.v - west.v) / (2.0 * kStep), 1e-7) << x << " " << y;
      EXPECT_NEAR(here.across.y(), (north.v - south.v) / (2.0 * kStep), 1e-7) << x << " " << y;
    }
}

TEST(RoadLine, the_segment_beside_the_nearest_point_of_the_whole_line_is_found) {
  std::vector<double> headings;  // winds itself up: turns of 12 m to 3 m of radius
  for (double heading = 0.0, radius = 12.0; radius > 3.0; radius -= 0.02)
    headings.push_back(heading), heading += kIncrement / radius;
  const RoadLine line({0.0, 0.0}, 0.0, kIncrement, headings);
  for (std::size_t k = 0; k < line.points(); k += 7)
    for (const double v : {-0.4, 0.0, 0.4}) {
      const RoadLine::Place at = line.place(line.beside(k, v));
      EXPECT_NEAR(at.u, kIncrement * static_cast<double>(k), 1e-9);
      EXPECT_NEAR(at.v, v, 1e-9);
    }
}

/// At the seam of a closed line a place is on the first or on the last segment; u goes on straight nowhere.
TEST(RoadLine, a_closed_line_has_no_gap_at_its_seam) {
  const int segments = 80;
  const RoadLine line = circle(2.0 * std::numbers::pi / segments, segments);
  for (const double y : {1.0, 2.0, 3.0}) {
    EXPECT_NEAR(line.place({1.1, y}).u, 3.0 + 0.1, 0.08);
    EXPECT_NEAR(line.place({0.9, y}).u, 3.0 + kIncrement * segments - 0.1, 0.08);
  }
}

class TurningRoad : public ::testing::Test {
 protected:
  GroundShape shape(const std::string& bytes, const RoadPlace& place = {.curved = true}, bool across = true) {
    std::ofstream(folder_.path() / "road.crg", std::ios::binary) << bytes;
    return read_shape(folder_.path() / "road.crg", place, across);
  }

  testing::TemporaryFolder folder_;
};

const std::string kBent =
    "$ROAD_CRG\nREFERENCE_LINE_START_U = 3.0\nREFERENCE_LINE_END_U = 17.0\nREFERENCE_LINE_START_X = 3.0\n"
    "REFERENCE_LINE_START_PHI = 0.2\nREFERENCE_LINE_INCREMENT = 2.0\n$\n$KD_DEFINITION\n#:LRFI\n"
    "D:reference line phi,rad\nD:long section at v = -1.5,m\nD:long section at v = 0.0,m\n"
    "D:long section at v = 2.0,m\n$\n$$\n"
    " *missing* 0.0100000 0.0000000 0.0300000\n 0.2000000 0.0200000 0.0100000 0.0200000\n"
    " 0.3000000 0.0400000 0.0200000 0.0100000\n 0.5000000 0.0100000 0.0500000 0.0400000\n"
    " 0.6000000 0.0000000 0.0300000 0.0700000\n 0.5000000 0.0200000 0.0100000 0.0200000\n"
    " 0.3000000 0.0500000 0.0000000 0.0100000\n 0.2000000 0.0300000 0.0200000 0.0600000\n";

/// Values of the evaluator of ASAM OpenCRG (C-API 1.1.2) on this road with headings from 0 on, which begins at x = 0
/// there; its heights are single precision.
TEST_F(TurningRoad, places_and_heights_are_those_of_the_evaluator_of_asam) {
  const GroundShape road = shape(kBent);
  ASSERT_TRUE(road.map && road.map->line);
  EXPECT_TRUE(road.remarks().empty());
  const double rows[][5] = {{4.0, 0.1, 6.990016695219, -0.100166416766, 0.021282301918},
                            {6.5, -1.0, 8.955243098997, -1.887838757512, 0.010671353277},
                            {8.3, 1.9, 11.630366363429, 0.151033855669, 0.026002963027},
                            {10.0, 2.4, 13.383257133404, 0.203624926990, 0.009101838764},
                            {13.2, 4.1, 16.575014992440, 1.739748822150, 0.044999871614},
                            {5.9, 1.7, 9.311543837240, 0.837779401418, 0.045958227247},
                            {16.0, 5.5, 19.356515394380, 3.139748822150, 0.059999998659}};
  const GroundHeights heights = road.heights();
  for (const auto& [x, y, u, v, z] : rows) {
    const RoadLine::Place at = road.map->line->place({3.0 + x, y});
    EXPECT_NEAR(at.u, u, 1e-9);
    EXPECT_NEAR(at.v, v, 1e-9);
    EXPECT_NEAR(heights(3.0 + x, y), z, 1e-8);
  }
  EXPECT_NEAR(heights(-4.0, 1.0), 0.015, 1e-9);  // before it
  // A shift along x, and v = 1.5 m at y = 0 where it begins.
  const GroundHeights moved = shape(kBent, {.v = 1.5, .from = 8.0, .curved = true}).heights();
  EXPECT_NEAR(moved(8.0 + 5.9, 1.7 - 1.5), heights(3.0 + 5.9, 1.7), 1e-12);
  const UnevenPart part = road.uneven();
  EXPECT_EQ(part.from, 3.0);
  EXPECT_NEAR(part.right, -1.5, 1e-12);
  EXPECT_GT(part.left, 4.0);
}

TEST_F(TurningRoad, what_has_no_line_or_too_sharp_a_one_is_refused) {
  const auto refused = [&](const std::string& words, const std::function<void()>& read) {
    expect_refused(ExitCode::bad_input, {words}, read);
  };
  refused("is read along its reference line (terrain.profile_line curved), expected terrain.profile_across true",
          [&] { shape(kBent, {.curved = true}, false); });
  std::string sharp = kBent;
  sharp.replace(sharp.find("0.6000000"), 9, "2.1000000");
  refused(
      "turns at u = 7 m so sharply that its cross-sections meet 1.77 m beside the reference line, but has heights "
      "at v = 2 m: expected terrain.profile_line straight",
      [&] { shape(sharp); });
  refused("has one y alone", [&] {
    shape(
        "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 2.0\n$\n$KD_DEFINITION\n#:LRFI\nD:long section at v = 0,m\n$\n$$\n"
        " 0.0100000\n 0.0200000\n");
  });
  std::ofstream(folder_.path() / "grid.csv") << "x_m,y_m,z_m\n0,0,0\n0,1,0\n1,0,0\n1,1,0\n";
  refused("has no reference line, expected OpenCRG with terrain.profile_line curved",
          [&] { read_shape(folder_.path() / "grid.csv", {.curved = true}, true); });
}

/// A circle of 20 m that is banked by 0.1: a cone about its centre.
HeightMap banked_circle() {
  const double turn = 0.025;
  HeightMap map;
  std::vector<double> headings;
  for (int k = 0; k <= 240; ++k) map.x.push_back(k * kIncrement);
  for (int k = 0; k < 240; ++k) headings.push_back(k * turn);
  map.y = {-2.0, 0.0, 2.0};
  for (int k = 0; k <= 240; ++k)
    for (const double v : map.y) map.z.push_back(0.1 * v);
  map.line = std::make_shared<const RoadLine>(RoadLine::Vec2(0.0, 0.0), 0.0, kIncrement, headings);
  return map;
}

TEST(TurningGround, a_banked_circle_is_a_cone) {
  const GroundMap map(banked_circle());
  const double inner = 0.5 * kIncrement / std::tan(0.0125), bulge = inner / std::cos(0.0125) - inner;
  for (double angle = 0.1; angle < 5.9; angle += 0.31)
    for (const double r : {18.5, 20.0, 21.2}) {
      const double x = 0.5 * kIncrement + r * std::sin(angle), y = inner - r * std::cos(angle);
      EXPECT_NEAR(map.height(x, y), 0.1 * (inner - r), 0.11 * bulge) << angle << " " << r;
      EXPECT_NEAR(map.cosine(x, y), 1.0 / std::sqrt(1.01), 1e-12) << angle << " " << r;
    }
  const double down = inner - 20.0;  // of the middle of the first segment at y = 0: v = 0 … −0.5 m
  EXPECT_NEAR(map.highest(0.1, 0.3, -0.5, 0.0), 0.0, 1e-3 + 0.1 * std::abs(down));
  EXPECT_NEAR(map.mean(0.1, 0.3, -0.5, 0.0), -0.025, 1e-9);
}

/// κ V along the normal of the cone where the box is; the cone bends by (0.1 m)²/(2 · 20 m) under it.
TEST(TurningGround, a_box_is_pushed_along_the_normal_of_the_road_where_it_is) {
  GroundOptions options;
  options.map = std::make_shared<const HeightMap>(banked_circle());
  options.ground_stiffness = 1e7;
  options.ground_damping = 0.0;
  const double inner = 0.5 * kIncrement / std::tan(0.0125), deep = 0.03;
  for (const double angle : {0.4, 1.9, 4.5}) {
    const testing::Surface box = testing::box({-0.05, -0.05, 0.0}, {0.05, 0.05, 0.3});
    const Vec3 at(0.5 * kIncrement + 20.3 * std::sin(angle), inner - 20.3 * std::cos(angle), 0.1 * (inner - 20.3));
    const auto ground = ground_under(box, placed(box, at + Vec3(0.0, 0.0, 0.2), Vec3::Zero()), options, 0.0);
    const SurfaceState in = placed(box, at - Vec3(0.0, 0.0, deep), Vec3::Zero());
    push(*ground, in, 1e-3);
    const Vec3 force = push(*ground, in, 1e-3).sums.force;
    const Vec3 normal = Vec3(0.1 * std::sin(angle), -0.1 * std::cos(angle), 1.0).normalized();
    EXPECT_LT((force - options.ground_stiffness * deep * 0.01 * normal).norm(), 5e-3 * force.norm()) << angle;
  }
}

TEST(TurningGround, contact_gives_back_what_it_took) {
  HeightMap map = banked_circle();
  for (std::size_t k = 0; k < map.x.size(); ++k)
    for (std::size_t cut = 0; cut < 3; ++cut) map.z[3 * k + cut] += 0.01 * std::sin(0.8 * k + 1.3 * cut);
  GroundOptions options;
  options.map = std::make_shared<const HeightMap>(map);
  options.ground_stiffness = 1e7;
  options.ground_damping = 0.0;
  const GroundMap heights(map);
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 3);
  const Vec3 middle(14.0, 6.0, heights.height(14.0, 6.0) + 0.42);
  const auto at = [&](double phase) -> Vec3 {
    const double angle = 2.0 * M_PI * phase;
    return middle + Vec3(0.05 * (1.0 - std::cos(angle)), 0.04 * std::sin(angle), -0.04 * (1.0 - std::cos(angle)));
  };
  const int steps = 1000;
  const auto ground = ground_under(wheel, placed(wheel, at(0.0), Vec3::Zero()), options, 0.0);
  const double duration = 1e-3, first = ground->gather_state().elastic_energy;
  double work = 0.0, taken = 0.0, most = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Vec3 velocity = (at((k + 1.0) / steps) - at(double(k) / steps)) / duration;
    const Push one = push(*ground, placed(wheel, at(double(k) / steps), velocity), duration);
    const double step = -one.sums.force.dot(velocity) * duration;
    work += step, taken += std::abs(step);
    most = std::max(most, ground->gather_state().elastic_energy - first);
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(std::abs(work), 0.005 * taken);
}

}  // namespace
}  // namespace furrow::terrain
