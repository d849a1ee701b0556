// Spatial rotation: free bodies and the heavy symmetric top.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vehicle/multibody/system.hpp"

using namespace furrow;

TEST(FreeBody, asymmetric_body_keeps_angular_momentum_and_bounded_energy) {
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.orientation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 1, 0).normalized()));
  state.angular_velocity = Vec3(0.1, 6.0, 0.05);  // near the unstable middle axis: it tumbles
  system.add_body("book", 1.0, Vec3(0.5, 1.0, 1.4).asDiagonal(), state);
  system.assemble(0.0);
  const Vec3 momentum = system.angular_momentum(Vec3::Zero());
  const double energy = system.kinetic_energy();
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    EXPECT_TRUE(system.step(2e-3).ok);
    worst = std::max(worst, std::abs(system.kinetic_energy() / energy - 1.0));
  }
  EXPECT_LT((system.angular_momentum(Vec3::Zero()) - momentum).norm(), 1e-13 * momentum.norm());
  EXPECT_LT(worst, 1e-4);
}

// The axis of a free symmetric body turns about ℓ at the rate |ℓ|/I_t [Goldstein, Classical Mechanics, §5.6].
TEST(FreeBody, symmetric_body_precesses_at_the_closed_form_rate) {
  const auto error_of = [](int steps) {
    vehicle::System system(Vec3::Zero());
    const double axial = 0.2, transverse = 0.5;
    vehicle::BodyState state;
    state.angular_velocity = Vec3(1.0, 0.0, 8.0);
    system.add_body("disc", 1.0, Vec3(transverse, transverse, axial).asDiagonal(), state);
    system.assemble(0.0);
    const Vec3 momentum = system.angular_momentum(Vec3::Zero());
    const double end = 2.0;
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(end / steps).ok);
    const Vec3 reference = Eigen::AngleAxisd(momentum.norm() / transverse * end, momentum.normalized()) * Vec3::UnitZ();
    return (system.body(0).R.col(2) - reference).norm();
  };
  const double coarse = error_of(1000), fine = error_of(2000);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

// Steady precession of a heavy top at tilt θ: J ω₃ Ω − I Ω² cos θ = m g l, J axial, I transverse about the
// tip, ω₃ the component of ω along the axis [Goldstein, Classical Mechanics, §5.7].
TEST(Top, steady_precession_matches_goldstein) {
  const double m = 1.2, l = 0.15, axial = 4e-3, central = 3e-3, tilt = 0.6, precession = 2.0;
  const double transverse = central + m * l * l;
  const double spin = (m * 9.81 * l + transverse * precession * precession * std::cos(tilt)) / (axial * precession);
  vehicle::System system;
  vehicle::BodyState state;
  state.orientation = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  const Vec3 axis = state.orientation * Vec3::UnitZ();
  state.position = l * axis;
  state.angular_velocity = precession * (Vec3::UnitZ() - std::cos(tilt) * axis) + spin * axis;
  state.velocity = state.angular_velocity.cross(state.position);
  const int top = system.add_body("top", m, Vec3(central, central, axial).asDiagonal(), state);
  const int tip = system.add_joint(vehicle::JointKind::spherical, "tip", vehicle::kGround, top, vehicle::JointPlace{});
  system.assemble(0.0);
  const int steps = 20000;
  const double end = 1.0;
  double worst_tilt = 0.0;
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(system.step(end / steps).ok);
    worst_tilt = std::max(worst_tilt, std::abs(std::acos(system.body(top).R(2, 2)) - tilt));
  }
  const Vec3 end_axis = system.body(top).R.col(2);
  EXPECT_LT(worst_tilt, 1e-4);
  EXPECT_NEAR(std::atan2(end_axis.y(), end_axis.x()), precession * end, 2e-4);
  // Horizontal: centripetal force towards the vertical; vertical: the weight.
  const Vec3 force = system.reaction(tip).force;
  EXPECT_NEAR(force.z(), m * 9.81, 1e-3 * m * 9.81);
  EXPECT_NEAR(force.head<2>().norm(), m * precession * precession * l * std::sin(tilt), 2e-3 * m * 9.81);
  EXPECT_LT(system.reaction(tip).moment.norm(), 1e-10);
  EXPECT_NEAR(system.angular_momentum(Vec3::Zero()).z(),
              axial * spin * std::cos(tilt) + transverse * precession * std::sin(tilt) * std::sin(tilt), 1e-12);
}
