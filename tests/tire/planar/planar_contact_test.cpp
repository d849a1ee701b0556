// Contact of the planar tire against closed forms: its laws, points in the ground, corners in the tire.
#include "tire/planar/planar_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/tire/planar/planar_examples.hpp"
#include "tire/planar/rubbing_contact.hpp"

namespace furrow::tire {
namespace {

TEST(PlanarContactLaw, pushes_with_the_depth_but_no_farther_than_out) {
  const double c = 1e5, m = 0.2, h = 1e-3, dt = 1e-4;
  EXPECT_EQ(planar_normal_force(c, h, 0.0, m, dt), 100.0);
  EXPECT_EQ(planar_normal_force(c, h, -3.0, m, dt), 100.0);  // approaching
  // d = ½ F/m Δt² + v_n Δt: 2.5e-6 + 2e-3 m for 20 m/s, twice the depth
  EXPECT_NEAR(planar_normal_force(c, h, 20.0, m, dt), 100.0 * h / 2.0025e-3, 1e-9);
  EXPECT_NEAR(planar_normal_force(1e12, h, 0.0, m, dt), 2.0 * m * h / (dt * dt), 1e-6);  // however stiff
  EXPECT_EQ(planar_normal_force(c, 0.0, 5.0, m, dt), 0.0);
}

TEST(PlanarContactLaw, friction_is_coulombs_and_brings_to_rest_at_most) {
  EXPECT_EQ(planar_friction_force(0.8, 100.0, 3.0, 0.2, 1e-4), 80.0);
  EXPECT_EQ(planar_friction_force(0.8, 100.0, -3.0, 0.2, 1e-4), 80.0);
  const double force = planar_friction_force(0.8, 100.0, 0.02, 0.2, 1e-4);
  EXPECT_NEAR(force, 40.0, 1e-12);
  EXPECT_NEAR(0.02 - force / 0.2 * 1e-4, 0.0, 1e-15);
}

TEST(PlanarGround, depth_goes_to_the_nearest_side_also_of_upright_ones) {
  const PlanarGround curb = PlanarGround::curb(0.2, 5.0);
  EXPECT_EQ(curb.depth(-1.0, 0.01).depth, 0.0);
  EXPECT_EQ(curb.depth(-1.0, -0.01).depth, 0.01);
  EXPECT_EQ(curb.depth(-0.001, 0.1).depth, 0.0);
  const PlanarDepth side = curb.depth(0.02, 0.1), top = curb.depth(0.5, 0.19);
  EXPECT_NEAR(side.depth, 0.02, 1e-15);
  EXPECT_NEAR(side.out_x, -1.0, 1e-15);
  EXPECT_NEAR(top.depth, 0.01, 1e-15);
  EXPECT_NEAR(top.out_z, 1.0, 1e-15);
  const PlanarDepth foot = curb.depth(0.03, -0.04);  // nearest to the foot of the curb, where both sides end
  EXPECT_NEAR(foot.depth, 0.05, 1e-15);
  EXPECT_NEAR(foot.out_x, -0.6, 1e-12);
  EXPECT_EQ(curb.depth(6.0, -1.0).depth, 0.0);  // beyond the end
  EXPECT_EQ(curb.top(), 0.2);
  ASSERT_EQ(curb.corners().size(), 3U);  // the ends and the edge
  EXPECT_EQ(curb.corners()[1].z, 0.2);
  const PlanarGround bar = PlanarGround::bar(0.05, 0.1);
  EXPECT_NEAR(bar.depth(0.12, -0.03).out_x, 1.0, 1e-15);
  EXPECT_EQ(bar.depth(0.07, -0.03).depth, 0.0);
}

TEST(PlanarGround, depth_is_that_of_all_sides_looked_at_one_by_one) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::vector<PlanarPoint> points{{0.0, 0.0}};
  for (int k = 0; k < 60; ++k)
    points.push_back({points.back().x + (any(random) < 0.2 ? 0.0 : 0.1 * any(random)), 0.3 * any(random)});
  const PlanarGround ground(points);
  const double length = points.back().x;
  for (int n = 0; n < 3000; ++n) {
    const double x = length * any(random), z = 0.7 * any(random) - 0.4;
    double height = 0.0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < points.size(); ++k) {
      const PlanarPoint &a = points[k - 1], &b = points[k];
      if (a.x < x && x <= b.x) height = a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x);
      const double dx = b.x - a.x, dz = b.z - a.z;
      const double s = std::clamp(((x - a.x) * dx + (z - a.z) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(a.x + s * dx - x, a.z + s * dz - z));
    }
    EXPECT_NEAR(ground.depth(x, z).depth, z < height ? nearest : 0.0, 1e-14) << x << " " << z;
  }
}

/// A square of four triangles around its middle, from (−1, 0) to (1, 2).
PlanarMesh square() {
  PlanarMesh m;
  m.position.x = {0.0, -1.0, 1.0, 1.0, -1.0}, m.position.z = {1.0, 0.0, 0.0, 2.0, 2.0};
  m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  m.part = {0, 0, 0, 0};
  m.outer = {1, 2, 3, 4};
  return m;
}

TEST(PlanarContact, nodes_in_the_ground_are_pushed_out_and_rubbed) {
  const PlanarMesh m = square();
  RubbingContact contact(m, PlanarGround::plate(5.0), {1e4, 0.5});
  PlanarState s{mapped(m.position, Eigen::Matrix2d::Identity(), 0.0, -0.01), PlanarField(5)};
  for (double& v : s.v.x) v = 2.0;
  PlanarField force(5);
  contact.load(s, std::vector<double>(5, 3.0), 1e-4, force);
  EXPECT_EQ(contact.touches().size(), 2U);
  for (const int n : {1, 2}) {
    EXPECT_NEAR(force.z[n], 100.0, 1e-12);
    EXPECT_NEAR(force.x[n], -50.0, 1e-12);
  }
  EXPECT_NEAR(contact.force_z(), 200.0, 1e-12);
  EXPECT_NEAR(contact.force_x(), -100.0, 1e-12);
}

TEST(PlanarContact, a_corner_in_the_tire_pushes_its_side_as_a_force_at_the_corner_does) {
  const PlanarMesh m = square();
  // A needle whose point is 0.04 m inside the lower side, at x = 0.5.
  RubbingContact contact(m, PlanarGround({{0.499, -3.0}, {0.5, 0.04}, {0.501, -3.0}}), {1e4, 0.5});
  PlanarState s{m.position, PlanarField(5)};
  for (double& v : s.v.x) v = -2.0;
  PlanarField force(5);
  std::vector<double> mass{1.0, 1.0, 4.0, 1.0, 1.0};
  contact.load(s, mass, 1e-6, force);
  ASSERT_EQ(contact.touches().size(), 1U);
  const PlanarTouch& touch = contact.touches()[0];
  EXPECT_NEAR(touch.depth, 0.04, 1e-12);
  EXPECT_NEAR(touch.share, 0.75, 1e-12);
  EXPECT_NEAR(force.z[1], 0.25 * 400.0, 1e-9);
  EXPECT_NEAR(force.z[2], 0.75 * 400.0, 1e-9);
  EXPECT_NEAR(force.x[1] + force.x[2], 200.0, 1e-9);  // friction, against its sliding
  // The force may push the side until it leaves the corner, with the mass of its point: 1/(0.25²/1 + 0.75²/4).
  contact.load(s, mass, 1.0, force = PlanarField(5));
  const double point = 1.0 / (0.0625 + 0.5625 / 4.0);
  EXPECT_NEAR(contact.touches()[0].force, std::min(400.0, 2.0 * point * 0.04), 1e-9);
  // Beside the tire, and above it, nothing touches.
  for (const double x : {-1.3, 1.2}) {
    RubbingContact aside(m, PlanarGround({{x - 0.001, -3.0}, {x, 0.5}, {x + 0.001, -3.0}}), {1e4, 0.5});
    aside.find(m.position);
    EXPECT_TRUE(aside.touches().empty());
  }
}

TEST(PlanarContact, force_at_rest_is_the_derivative_of_its_energy) {
  const PlanarMesh mesh = small_wheel();
  const PlanarGround rough(
      {{-1.0, 0.0}, {-0.1, 0.0}, {-0.1, 0.03}, {-0.05, 0.05}, {0.02, 0.01}, {0.07, 0.04}, {0.2, 0.0}, {1.0, 0.1}});
  PlanarContact contact(mesh, rough, {1e5, 0.0});
  const PlanarField x = along(mapped(mesh.position, Eigen::Matrix2d::Identity(), 0.013, 0.47),
                              random_planar(mesh.position.size(), 0.003, 3), 1.0);
  contact.find(x);
  int corners = 0, nodes = 0;
  for (const PlanarTouch& t : contact.touches()) ++(t.b < 0 ? nodes : corners);
  EXPECT_GE(corners, 1);
  EXPECT_GE(nodes, 2);
  PlanarField force(x.size());
  for (const PlanarTouch& t : contact.touches()) {
    const int b = t.b < 0 ? t.a : t.b;
    force.x[t.a] += (1 - t.share) * t.force * t.push_x, force.z[t.a] += (1 - t.share) * t.force * t.push_z;
    force.x[b] += t.share * t.force * t.push_x, force.z[b] += t.share * t.force * t.push_z;
  }
  const double total = std::sqrt(dot(force, force));
  for (unsigned seed = 1; seed < 5; ++seed) {
    const PlanarField way = random_planar(x.size(), 1.0, seed);
    const double h = 1e-7;
    contact.find(along(x, way, h));
    const double ahead = contact.energy();
    contact.find(along(x, way, -h));
    EXPECT_NEAR((ahead - contact.energy()) / (2 * h), -dot(force, way), 1e-5 * total);
  }
}

}  // namespace
}  // namespace furrow::tire
