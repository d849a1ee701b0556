// A planar wheel in motion against the momentum, energy and rolling of rigid wheels, and on a curb.
#include "tests/tire/planar/planar_wheel.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tire/planar/planar_examples.hpp"

namespace furrow::tire {
namespace {

constexpr double kGravity = 9.81;

PlanarParams stiff_wheel() {
  PlanarParams p;
  p.size = {.radius = 0.5, .rim_radius = 0.25, .rings = 4, .around = 36};
  p.disc = {900.0, 5e7, 0.3, 0.0}, p.tire = {300.0, 2e7, 0.4, 3000.0};
  p.options.width = 0.2;
  p.contact_stiffness = 2e7, p.friction = 0.6;
  return p;
}

double inertia(const PlanarWheel& wheel) {
  double sum = 0.0;
  const PlanarField& p = wheel.mesh().position;
  for (std::size_t n = 0; n < p.size(); ++n) sum += wheel.motion().mass()[n] * (p.x[n] * p.x[n] + p.z[n] * p.z[n]);
  return sum;
}

double momentum(const PlanarWheel& wheel, bool x) {
  double sum = 0.0;
  const PlanarField& v = wheel.motion().state().v;
  for (std::size_t n = 0; n < v.size(); ++n) sum += wheel.motion().mass()[n] * (x ? v.x[n] : v.z[n]);
  return sum;
}

TEST(PlanarWheel, a_couple_on_the_rim_turns_it_and_nothing_else) {
  PlanarWheel wheel(stiff_wheel(), PlanarGround::plate(1.0), {0.0, 2.0}, {0.0, 0.0}, 0.0, 30.0, 0.0);
  const double couple = 400.0;
  wheel.set_couple(couple);
  const int steps = 2000;
  for (int k = 0; k < steps; ++k) ASSERT_TRUE(wheel.advance().ok);
  const double time = steps * wheel.step();
  double spin = 0.0;
  const PlanarState& s = wheel.motion().state();
  for (std::size_t n = 0; n < s.x.size(); ++n)
    spin += wheel.motion().mass()[n] * ((s.x.z[n] - 2.0) * s.v.x[n] - s.x.x[n] * s.v.z[n]);
  EXPECT_NEAR(spin, couple * time, 1e-9 * couple * time);
  EXPECT_NEAR(momentum(wheel, true), 0.0, 1e-9);
  EXPECT_NEAR(wheel.spin(), couple * time / inertia(wheel), 0.02 * couple * time / inertia(wheel));
}

TEST(PlanarWheel, impulses_of_ground_and_weight_are_what_its_momentum_gains) {
  for (const PlanarIntegrator kind : {PlanarIntegrator::semi_implicit_euler, PlanarIntegrator::runge_kutta_4}) {
    PlanarParams p = stiff_wheel();
    p.integrator = kind;
    PlanarWheel wheel(p, PlanarGround::plate(5.0), {0.0, 0.51}, {2.0, -1.0}, 0.0, 40.0, kGravity);
    const double x = momentum(wheel, true), z = momentum(wheel, false);
    double ground_x = 0.0, ground_z = 0.0, highest = 0.0;
    int steps = 0;
    for (; steps < 4000; ++steps) {
      ASSERT_TRUE(wheel.advance().ok);
      ground_x += wheel.contact().force_x() * wheel.step(), ground_z += wheel.contact().force_z() * wheel.step();
      highest = std::max(highest, wheel.contact().force_z());
      for (const PlanarTouch& t : wheel.contact().touches())
        EXPECT_LE(std::abs(t.friction), 0.6 * t.force * (1 + 1e-12));
    }
    EXPECT_GT(highest, 5.0 * wheel.mass() * kGravity);
    EXPECT_GT(wheel.centre_velocity().z, -1.0);
    // Sums of the first stages equal those of the Runge–Kutta method to first order.
    const double share = kind == PlanarIntegrator::semi_implicit_euler ? 1e-10 : 0.03;
    const double weight = wheel.mass() * kGravity * steps * wheel.step();
    EXPECT_NEAR(momentum(wheel, true) - x, ground_x, share * std::abs(x));
    EXPECT_NEAR(momentum(wheel, false) - z, ground_z - weight, share * std::abs(z));
  }
}

TEST(PlanarWheel, a_spinning_wheel_slides_until_it_rolls_at_the_speed_of_a_rigid_one) {
  // About a point of the ground only the offset of the pressure has a moment: v = I ω₀ R / (I + m R²).
  PlanarWheel wheel(stiff_wheel(), PlanarGround::plate(20.0), {0.0, 0.4998}, {0.0, 0.0}, 10.0, 0.0, kGravity);
  const double i = inertia(wheel), m = wheel.mass();
  bool slid = false;
  for (int k = 0; k * wheel.step() < 0.6; ++k) {
    ASSERT_TRUE(wheel.advance().ok);
    if (const double normal = wheel.contact().force_z(); normal > 0.0 && k * wheel.step() < 0.1) {
      EXPECT_NEAR(wheel.contact().force_x(), 0.6 * normal, 1e-9 * normal);
      slid = true;
    }
  }
  EXPECT_TRUE(slid);
  const double speed = i * 10.0 * 0.5 / (i + m * 0.25);
  EXPECT_NEAR(wheel.centre_velocity().x, speed, 0.05 * speed);
  EXPECT_NEAR(wheel.spin() * 0.5, wheel.centre_velocity().x, 0.05 * speed);
}

TEST(PlanarWheel, the_link_holds_directions_and_tells_what_it_resists) {
  PlanarWheel wheel(stiff_wheel(), PlanarGround::plate(5.0), {0.0, 0.5}, {1.0, 0.0}, 2.0, 0.0, kGravity);
  PlanarLink link;
  link.hold_x = true, link.velocity_x = 1.0;
  link.force_z = -2000.0;  // load
  wheel.link(link);
  double force = 0.0;
  int steps = 0;
  for (int k = 0; k * wheel.step() < 1.0; ++k) {
    ASSERT_TRUE(wheel.advance().ok);
    if (k * wheel.step() > 0.6) force += wheel.contact().force_z(), ++steps;
  }
  EXPECT_NEAR(wheel.centre().x, 1.0, 2 * wheel.step());
  EXPECT_NEAR(force / steps, 2000.0 + wheel.mass() * kGravity, 0.05 * 2000.0);
}

TEST(PlanarWheel, it_climbs_a_curb_which_it_touches_before_its_centre_is_there) {
  PlanarParams p = stiff_wheel();
  p.tire = {300.0, 1e6, 0.4, 500.0};
  PlanarWheel wheel(p, PlanarGround::curb(0.1, 5.0), {-0.7, 0.495}, {2.0, 0.0}, 4.0, 100.0, kGravity);
  PlanarLink link;
  link.hold_x = true, link.velocity_x = 2.0;
  wheel.link(link);
  bool corner = false;
  double first = 0.0, highest = 0.0;
  for (int k = 0; wheel.centre().x < 0.7; ++k) {
    ASSERT_TRUE(wheel.advance().ok) << wheel.centre().x;
    for (const PlanarTouch& t : wheel.contact().touches()) corner = corner || t.b >= 0;
    const bool on_curb = std::any_of(wheel.contact().touches().begin(), wheel.contact().touches().end(),
                                     [](const PlanarTouch& t) { return t.push_x < -0.1; });
    if (on_curb && first == 0.0) first = wheel.centre().x;
    highest = std::max(highest, wheel.centre().z);
  }
  // A rigid circle touches the edge at √(R² − (R − h)²) = 0.3 m before it.
  EXPECT_NEAR(first, -0.3, 0.05);
  EXPECT_TRUE(corner);
  EXPECT_GT(highest, 0.58);
}

TEST(PlanarWheel, a_wheel_that_is_crushed_says_so) {
  PlanarParams p = stiff_wheel();
  p.tire = {300.0, 1e5, 0.4, 0.0};
  PlanarWheel wheel(p, PlanarGround::plate(5.0), {0.0, 0.5}, {0.0, -40.0}, 0.0, 500.0, kGravity);
  Outcome outcome;
  for (int k = 0; k < 40000 && outcome.ok; ++k) outcome = wheel.advance();
  EXPECT_FALSE(outcome.ok);
  EXPECT_TRUE(holds(outcome.detail, "step_share"));
}

}  // namespace
}  // namespace furrow::tire
