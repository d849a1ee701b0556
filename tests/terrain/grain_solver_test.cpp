// Few grains through the whole solver: collisions, equilibria, conservation, identities.
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/core/constants.hpp"
#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kRadius = 0.006;

/// Head-on collision; returns the ratio of relative speeds after and before.
double rebound(const FewGrains& few, double speed) {
  GrainSolver s = few.make({{0.3 - 0.00605, 0, 0.3}, {0.3 + 0.00605, 0, 0.3}});
  set_velocity(s, 0, {0.5 * speed, 0, 0});
  set_velocity(s, 1, {-0.5 * speed, 0, 0});
  const bool parted = step_until_parted(s, few.options.step, 200000);
  return parted ? (velocity(s, 1) - velocity(s, 0)).x() / speed : 0.0;
}

TEST(GrainSolver, restitution_is_the_one_asked_for) {
  for (double e : {0.2, 0.3, 0.5, 0.7, 0.9, 1.0})
    for (double speed : {0.1, 1.0}) {
      FewGrains few;
      few.options.restitution = e;
      few.options.step = 2e-7;
      EXPECT_NEAR(rebound(few, speed), e, 2e-3) << "e = " << e << ", speed = " << speed;
    }
}

TEST(GrainSolver, wall_restitution_is_the_one_asked_for) {
  FewGrains few;
  few.options.restitution = 0.6;
  GrainSolver s = few.make({{0.3, 0, 0.00601}});
  set_velocity(s, 0, {0, 0, -0.5});
  for (int k = 0; k < 20000 && velocity(s, 0).z() < 0.2999; ++k) s.step(1e-6);
  EXPECT_NEAR(velocity(s, 0).z(), 0.3, 1e-3);
}

TEST(GrainSolver, sliding_sphere_rolls_at_five_sevenths) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    FewGrains few;
    few.options.law = law;
    few.options.friction = 0.3;
    few.options.friction_velocity_scale = 500.0;
    few.gravity = kStandardGravity;
    GrainSolver s = few.make({{0.1, 0, few.resting_height()}});
    set_velocity(s, 0, {0.4, 0, 0});
    for (int k = 0; k < 20000; ++k) s.step(1e-5);
    EXPECT_NEAR(velocity(s, 0).x(), 0.4 * 5.0 / 7.0, 1e-3) << law;
    EXPECT_NEAR(spin(s, 0).y() * kRadius, velocity(s, 0).x(), 1e-3) << law;
  }
}

TEST(GrainSolver, restitution_zero_takes_the_limit) {
  FewGrains few;
  few.options.restitution = 0.0;
  few.options.step = 1e-6;
  EXPECT_LT(std::abs(rebound(few, 1.0)), 5e-3);
}

TEST(GrainSolver, cohesive_grains_rest_at_the_reports_overlap) {
  FewGrains few;
  few.options.law = "hertz_tanh";
  few.options.cohesion = 80e3;
  GrainSolver s = few.make({{0.3, 0, 0.3}, {0.3 + 0.01185, 0, 0.3}});
  for (int k = 0; k < 20000; ++k) s.step(1e-5);
  EXPECT_NEAR(2 * kRadius - (position(s, 1) - position(s, 0)).norm(), 0.434e-3, 1e-6);
}

/// A grain on a floor that falls along x, kept from rolling; returns its speed at the end.
double speed_on_incline(const FewGrains& few, double angle, double time) {
  FewGrains tilted = few;
  tilted.gravity = kStandardGravity;
  tilted.slope = angle;
  GrainSolver s = tilted.make({{0.1, 0, tilted.resting_height()}});
  const double dt = few.options.step;
  for (double t = 0; t < time; t += dt) {
    s.step(dt);
    set_spin(s, 0, Vec3::Zero());  // a block: only sliding
  }
  return velocity(s, 0).x();
}

TEST(GrainSolver, sliding_block_on_a_slope_accelerates_by_g_times_sine_less_friction_times_cosine) {
  FewGrains few;
  few.options.friction = 0.2;
  few.options.step = 1e-5;
  const double angle = 0.4, time = 0.1;
  const double expected = kStandardGravity * (std::sin(angle) - 0.2 * std::cos(angle)) * time;
  // The spring of friction takes a moment to stretch to its limit.
  EXPECT_NEAR(speed_on_incline(few, angle, time), expected, 5e-3 * expected);
}

TEST(GrainSolver, grains_fall_along_a_tilted_gravity_and_keep_their_energy) {
  FewGrains few;
  few.gravity = kStandardGravity;
  few.slope = 0.5;
  GrainSolver s = few.make({{0.1, 0.02, 0.5}, {0.2, -0.03, 0.4}});
  s.reset_accounts();
  const double weight = s.params().grain.mass * kStandardGravity, dt = 1e-5;
  const double before = s.accounts().kinetic + weight * s.accounts().height;
  const int steps = 10000;
  for (int k = 0; k < steps; ++k) s.step(dt);
  // Semi-implicit Euler: v = n dt g, x = x₀ + ½ n (n + 1) dt² g.
  const Vec3 g = s.params().gravity;
  for (const int id : {0, 1}) EXPECT_LT((velocity(s, id) - steps * dt * g).norm(), 1e-12);
  const Vec3 fallen = 0.5 * steps * (steps + 1.0) * dt * dt * g;
  EXPECT_LT((position(s, 0) - Vec3(0.1, 0.02, 0.5) - fallen).norm(), 1e-12);
  const double after = s.accounts().kinetic + weight * s.accounts().height;
  EXPECT_NEAR(after, before, 2e-4 * s.accounts().kinetic);  // ½ m g² t dt: first order
}

TEST(GrainSolver, hertz_tanh_creeps_on_an_incline_at_its_closed_form_rate_and_mindlin_holds) {
  FewGrains few;
  few.options.friction = 0.9;
  few.options.step = 1e-5;
  const double angle = 0.3;
  EXPECT_LT(std::abs(speed_on_incline(few, angle, 0.3)), 1e-4);
  few.options.law = "hertz_tanh";
  few.options.friction_impulse_limit = false;
  // m g sin = μ m g cos tanh(c v)
  const double creep = std::atanh(std::tan(angle) / 0.9) / 5.0;
  EXPECT_NEAR(speed_on_incline(few, angle, 1.0), creep, 2e-3 * creep);
}

TEST(GrainSolver, floor_carries_the_weight) {
  FewGrains few;
  few.gravity = kStandardGravity;
  GrainSolver s = few.make({{0.3, 0, 0.0059}, {0.3, 0.1, 0.006}, {0.3, 0.1, 0.0179}});
  s.set_drag(50.0);
  for (int k = 0; k < 20000; ++k) s.step(2e-5);
  EXPECT_NEAR(s.accounts().floor_force, 3 * s.params().grain.mass * kStandardGravity, 1e-6);
}

std::vector<Quad> cloud(int n, double spacing, std::uint64_t seed) {
  Uniform uniform(seed);
  std::vector<Quad> out;
  for (int k = 0; k < n; ++k)
    out.push_back({0.03 + spacing * (k % 18) + 2e-4 * uniform(), -0.1 + spacing * (k / 18 % 12) + 2e-4 * uniform(),
                   0.0065 + spacing * (k / 216) + 2e-4 * uniform(), 0.0});
  return out;
}

GrainSolver random_bed(FewGrains& few, int n, double speed) {
  few.options.length = 0.3, few.options.width = 0.24;
  GrainSolver s = few.make(cloud(n, 0.0126, 3));
  Uniform uniform(5);
  for (int id = 0; id < n; ++id) set_velocity(s, id, speed * Vec3::NullaryExpr([&] { return uniform(); }));
  s.reset_accounts();
  return s;
}

TEST(GrainSolver, crowd_keeps_momentum_and_books_its_energy) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    FewGrains few;
    few.options.law = law;
    few.options.cohesion = 20e3;
    few.options.step = 1e-5;
    GrainSolver s = random_bed(few, 1500, 0.5);
    SCOPED_TRACE(law);
    expect_books_close(s, 1e-5, 1500, 1e-13);
    EXPECT_GT(s.rebuilds(), 1);
  }
}

TEST(GrainSolver, same_bits_for_one_and_two_threads_and_after_a_restart) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    SCOPED_TRACE(law);
    FewGrains few;
    few.options.law = law;
    few.options.rolling_friction = 0.1;
    few.options.cohesion = 10e3;
    few.gravity = kStandardGravity;
    expect_same_bits([&] { return random_bed(few, 2500, 0.5); }, 2e-5, 500);
  }
}

/// This includes springs: springs of pairs that touch across a side must be kept when lists are made again.
TEST(GrainSolver, a_bed_shifted_along_periodic_sides_moves_the_same) {
  for (const Vec3& shift : {Vec3(0.15, 0, 0), Vec3(0, 0.12, 0), Vec3(0.07, 0.1, 0)}) {
    FewGrains few;
    few.options.periodic_x = true;
    few.options.sides = "periodic";
    few.options.rolling_friction = 0.1;
    few.gravity = kStandardGravity;
    GrainSolver here = random_bed(few, 2400, 0.5);
    std::vector<Quad> moved(here.grains().count);
    for (int g = 0; g < here.grains().count; ++g)
      moved[here.grains().id[g]] = quad(vec(here.grains().position[g]) + shift);
    GrainSolver there = few.make(moved);
    for (int id = 0; id < here.grains().count; ++id) set_velocity(there, id, velocity(here, id));
    for (int k = 0; k < 400; ++k) ASSERT_TRUE(here.step(2e-5) < 0 && there.step(2e-5) < 0);
    EXPECT_GT(here.rebuilds(), 2);
    double apart = 0.0;
    for (int id = 0; id < here.grains().count; ++id)
      apart = std::max(apart, (velocity(there, id) - velocity(here, id)).norm());
    EXPECT_LT(apart, 1e-9) << shift.transpose();
  }
}

TEST(GrainSolver, lost_and_invalid_grains_are_named) {
  FewGrains few;
  GrainSolver s = few.make({{0.3, 0, 0.3}, {0.1, 0, 0.3}});
  set_velocity(s, 1, {-1e5, 0, 0});
  EXPECT_EQ(s.step(1e-5), s.index_of(1));
  GrainSolver t = few.make({{0.3, 0, 0.3}, {0.1, 0, 0.3}});
  set_velocity(t, 0, {0, std::nan(""), 0});
  EXPECT_EQ(t.step(1e-5), t.index_of(0));
}

}  // namespace
}  // namespace furrow::terrain::dem
