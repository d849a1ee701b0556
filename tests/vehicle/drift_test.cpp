// Constraint drift over a million steps of a spatial mechanism with closed loop, imposed motion and damper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/verification/record.hpp"
#include "vehicle/multibody/system.hpp"

using namespace furrow;

TEST(Drift, stays_below_1e_9_over_a_million_steps) {
  vehicle::System system;
  vehicle::BodyState state;
  const int wheel = system.add_body("wheel", 4.0, Vec3(0.1, 0.2, 0.1).asDiagonal(), state);
  vehicle::JointPlace axle;
  axle.axis = Vec3::UnitY();
  const int bearing = system.add_joint(vehicle::JointKind::revolute, "bearing", vehicle::kGround, wheel, axle);
  system.add_motor("motor", bearing, [](double t) { return vehicle::Motion{8.56 * t, 8.56}; });
  state.position = Vec3(0.3, 0.0, -0.6);
  const int bob = system.add_body("bob", 1.0, Vec3(0.01, 0.02, 0.03).asDiagonal(), state);
  vehicle::JointPlace rod;
  rod.point = Vec3(0.2, 0.0, 0.0);
  rod.second_point = state.position;
  system.add_joint(vehicle::JointKind::distance, "rod", wheel, bob, rod);
  system.add_line_element("tether", vehicle::kGround, bob, Vec3(0, 0.5, 0), state.position,
                          [](double value, double rate, double) {
                            return vehicle::ElementForce{-50.0 * value - 2.0 * rate, 2.0};
                          });
  system.assemble(0.0);
  double worst = 0.0;
  const int steps = 1000000;
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(system.step(4e-5).ok);
    if (i % 1000 == 999) worst = std::max(worst, system.max_violation());
  }
  EXPECT_EQ(system.time(), steps * 4e-5);
  verification::verify("linkage with motor and damper, 1,000,000 steps", "largest violation of a constraint, m and rad",
                       worst, 0.0, 1e-11, "constraints", 1.0);
}
