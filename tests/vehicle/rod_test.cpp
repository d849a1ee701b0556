// Massless rods between bodies: rank, motion against closed forms, drift.
#include <gtest/gtest.h>

#include <numbers>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

vehicle::JointPlace rod(const Vec3& from, const Vec3& to, const Vec3& axis) {
  vehicle::JointPlace place;
  place.point = from;
  place.second_point = to;
  place.axis = axis;
  return place;
}

}  // namespace

// A ball hung on a hinged rod swings in the plane across the hinge: a simple pendulum of the rod's length there, with
// the quarter period √(l/g) K(sin θ₀/2), for any offset along the hinge.
TEST(RevoluteSpherical, ball_on_a_hinged_rod_is_a_plane_pendulum) {
  const double l = 0.8, angle = 1.4, offset = 0.3;
  const auto angle_after_quarter = [&](int steps) {
    vehicle::System system;
    vehicle::BodyState state;
    state.position = Vec3(l * std::sin(angle), offset, -l * std::cos(angle));
    state.angular_velocity = Vec3(1.0, -2.0, 3.0);  // the ball's own spin does not matter
    const int ball = system.add_body("ball", 3.0, 0.2 * Mat3::Identity(), state);
    const int joint = system.add_joint(vehicle::JointKind::revolute_spherical, "rod", vehicle::kGround, ball,
                                       rod(Vec3::Zero(), state.position, Vec3::UnitY()));
    system.assemble(0.0);
    EXPECT_EQ(system.joint(joint).row_count, 2);
    EXPECT_EQ(system.redundant_count(), 0);
    const double quarter = std::sqrt(l / kStandardGravity) * std::comp_ellint_1(std::sin(0.5 * angle));
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(quarter / steps).ok);
    EXPECT_LT(system.max_violation(), 1e-11);
    EXPECT_NEAR(system.body(ball).state.position.y(), offset, 1e-12);
    const Vec3& x = system.body(ball).state.position;
    return std::atan2(x.x(), -x.z());
  };
  const double coarse = angle_after_quarter(200), fine = angle_after_quarter(400);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

TEST(RevoluteSpherical, reaction_is_the_statics_of_a_strut) {
  // A slider on the vertical is held by an inclined strut: the strut carries the weight over the cosine.
  vehicle::System system;
  const int block = system.add_body("block", 10.0, Mat3::Identity(), {});
  const Vec3 foot(-0.3, 0.0, -0.4);
  system.add_joint(vehicle::JointKind::prismatic, "guide", vehicle::kGround, block, slide(Vec3::Zero(), Vec3::UnitZ()));
  const int strut = system.add_joint(vehicle::JointKind::revolute_spherical, "strut", vehicle::kGround, block,
                                     rod(foot, Vec3::Zero(), Vec3::UnitY()));
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 1);  // the guide holds y as well
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  const Vec3 force = system.joint(strut).frame_a.axes * system.reaction(strut).force;
  EXPECT_NEAR(force.z(), 10.0 * kStandardGravity, 1e-8);
  EXPECT_NEAR(force.x(), 10.0 * kStandardGravity * 0.3 / 0.4, 1e-8);
}

TEST(RevoluteSpherical, an_end_on_the_hinge_is_refused) {
  vehicle::System system;
  const int ball = system.add_body("ball", 3.0, Mat3::Identity(), {});
  EXPECT_THROW(system.add_joint(vehicle::JointKind::revolute_spherical, "rod", vehicle::kGround, ball,
                                rod(Vec3(0, 1, 0), Vec3::Zero(), Vec3::UnitY())),
               Error);
}

// A rack that slides along y steers an upright about z over a tie rod of length L: with the arm r at the angle φ and
// the rod's inner end Q, r² + Q² − 2 r Q cos(φ − ψ) = L², ψ the direction of Q. The rack carries −T dφ/dy.
TEST(Rack, steers_an_upright_by_the_law_of_cosines_and_carries_its_torque) {
  const Vec3 arm(-0.2, 0.05, 0.0), inner(-0.25, -0.4, 0.0);
  const double r = arm.norm(), L = (arm - inner).norm(), torque = 35.0;
  const auto angle_at = [&](double y) {
    const Vec3 Q = inner + Vec3(0, y, 0);
    const double across = std::acos((r * r + Q.squaredNorm() - L * L) / (2.0 * r * Q.norm()));
    return std::remainder(std::atan2(Q.y(), Q.x()) - across, 2.0 * std::numbers::pi);
  };
  ASSERT_NEAR(std::remainder(angle_at(0.0) - std::atan2(arm.y(), arm.x()), 2.0 * std::numbers::pi), 0.0, 1e-12);
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.position = inner;
  const int rack = system.add_body("rack", 9.07, Mat3::Identity(), state);
  const int upright = system.add_body("upright", 19.0, 0.3 * Mat3::Identity(), {});
  const int slider =
      system.add_joint(vehicle::JointKind::prismatic, "rack", vehicle::kGround, rack, slide(inner, Vec3::UnitY()));
  const int pin = system.add_joint(vehicle::JointKind::revolute, "kingpin", vehicle::kGround, upright,
                                   slide(Vec3::Zero(), Vec3::UnitZ()));
  system.add_joint(vehicle::JointKind::distance, "tie rod", rack, upright, rod(inner, arm, Vec3::UnitZ()));
  const int motor = system.add_motor("rack drive", slider, [](double t) { return vehicle::step_motion(t, 0.06, 1.0); });
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  system.set_load(upright, Vec3::Zero(), Vec3(0, 0, torque));
  for (int i = 1; i <= 1200; ++i) {
    ASSERT_TRUE(system.step(1e-3).ok);
    const double y = vehicle::step_motion(i * 1e-3, 0.06, 1.0).value;
    ASSERT_NEAR(system.coordinate(pin).value, std::remainder(angle_at(y) - angle_at(0.0), 2.0 * std::numbers::pi),
                1e-11);
  }
  const double slope = (angle_at(0.06 + 1e-6) - angle_at(0.06 - 1e-6)) / 2e-6;
  EXPECT_NEAR(system.motor_force(motor), -torque * slope, 1e-6);
}
