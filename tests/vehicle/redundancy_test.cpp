// More constraints than needed: unique motion, reactions of minimum norm, names of contradicting constraints.
#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

// A door on two hinges at ±b along z, its centre at a. 2 × 5 rows on 5 freedoms. Each hinge carries
// horizontal force ±F and moment M with 2 b F + 2 M = m g a; minimum of 2 F² + 2 M² gives F = b c, M = c, c =
// m g a / (2 (1 + b²)).
TEST(Redundancy, door_on_two_hinges_has_minimum_norm_reactions) {
  const double m = 30.0, a = 0.4, b = 0.8;
  vehicle::System system;
  const int door = system.add_body("door", m, Vec3(6.0, 7.0, 2.0).asDiagonal(), bar_state(Vec3(a, 0, 0), 0.0));
  const int upper = system.add_joint(vehicle::JointKind::revolute, "upper hinge", vehicle::kGround, door,
                                     slide(Vec3(0, 0, b), Vec3::UnitZ()));
  const int lower = system.add_joint(vehicle::JointKind::revolute, "lower hinge", vehicle::kGround, door,
                                     slide(Vec3(0, 0, -b), Vec3::UnitZ()));
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 5);
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(system.step(1e-3).ok);
  const double c = m * kStandardGravity * a / (2.0 * (1.0 + b * b));
  const auto world = [&](int joint) {
    const Mat3& axes = system.joint(joint).frame_a.axes;
    return vehicle::Reaction{axes * system.reaction(joint).force, axes * system.reaction(joint).moment};
  };
  const double scale = m * kStandardGravity;
  EXPECT_NEAR(world(upper).force.z(), 0.5 * scale, 1e-6 * scale);
  EXPECT_NEAR(world(lower).force.z(), 0.5 * scale, 1e-6 * scale);
  EXPECT_NEAR(world(upper).force.x(), -b * c, 1e-6 * scale);
  EXPECT_NEAR(world(lower).force.x(), b * c, 1e-6 * scale);
  EXPECT_NEAR(world(upper).moment.y(), -c, 1e-6 * scale);
  EXPECT_NEAR(world(lower).moment.y(), -c, 1e-6 * scale);
  // The sums are exact for any split.
  EXPECT_NEAR(world(upper).force.z() + world(lower).force.z(), scale, 1e-10 * scale);
}

TEST(Redundancy, minimal_joints_are_not_flagged) {
  vehicle::System system;
  const int bar = system.add_body("bar", 1.0, Mat3::Identity(), bar_state(Vec3(0, 0, -1), 0.0));
  system.add_joint(vehicle::JointKind::revolute, "hinge", vehicle::kGround, bar, hinge(Vec3::Zero()));
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  EXPECT_TRUE(system.redundant_names().empty());
}

TEST(Redundancy, contradicting_motors_are_an_error_that_names_one) {
  vehicle::System system;
  const int cart = system.add_body("cart", 1.0, Mat3::Identity(), vehicle::BodyState{});
  const int rail = system.add_joint(vehicle::JointKind::prismatic, "rail", vehicle::kGround, cart,
                                    slide(Vec3::Zero(), Vec3::UnitX()));
  system.add_motor("slow motor", rail, [](double t) { return vehicle::Motion{t, 1.0}; });
  system.add_motor("fast motor", rail, [](double t) { return vehicle::Motion{2.0 * t, 2.0}; });
  expect_refused(ExitCode::physics, {"motor'"}, [&] {
    system.assemble(0.0);
    EXPECT_TRUE(system.step(1e-3).ok);
  });
}

TEST(Redundancy, joints_that_cannot_be_assembled_are_an_error) {
  vehicle::System system;
  const int block = system.add_body("block", 1.0, Mat3::Identity(), vehicle::BodyState{});
  system.add_joint(vehicle::JointKind::fixed, "here", vehicle::kGround, block, slide(Vec3::Zero(), Vec3::UnitZ()));
  vehicle::BodyState state;
  state.position = Vec3(1.0, 0.0, 0.0);
  system.set_state(block, state);
  system.add_joint(vehicle::JointKind::fixed, "there", vehicle::kGround, block, slide(Vec3::Zero(), Vec3::UnitZ()));
  EXPECT_THROW(system.assemble(0.0), Error);
}
