// Massless rods between bodies: rank, motion against closed forms, drift.
#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/vehicle/hmmwv.hpp"
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
// the quarter period √(l/g) K(sin θ₀/2), whatever the offset along the hinge.
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
  system.add_joint(vehicle::JointKind::prismatic, "guide", vehicle::kGround, block,
                   slide(Vec3::Zero(), Vec3::UnitZ()));
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

// 19 bodies with 100 rows and no redundancy leave 14 freedoms: 6 of the chassis, 4 wheels that bounce and 4 that spin.
TEST(Suspension, hmmwv_with_pitman_arm_has_19_bodies_100_rows_and_14_freedoms_and_does_not_drift) {
  Hmmwv hmmwv;
  vehicle::System& system = hmmwv.system;
  EXPECT_EQ(system.body_count(), 19);
  EXPECT_EQ(system.constraint_count(), 100);
  EXPECT_EQ(system.redundant_count(), 0);
  EXPECT_EQ(6 * system.body_count() - system.constraint_count(), 14);
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(system.step(1e-3).ok);
    worst = std::max(worst, system.max_violation());
  }
  EXPECT_LT(worst, 1e-11);
}
