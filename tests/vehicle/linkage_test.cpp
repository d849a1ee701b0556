// Linkages: reactions and motor torques against statics, imposed motions against kinematics.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "protocol/core/constants.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

// Slider-crank in the x–z plane: crank r at the origin, rod l, slider along x. Angle φ from +x towards −z
// (positive about +y). x_s = r cos φ + √(l² − r² sin² φ).
struct SliderCrank {
  static constexpr double r = 0.3, l = 0.9;
  vehicle::System system;
  int crank, rod, slider, crank_pin, big_end, small_end, guide, motor;

  SliderCrank(double phi, vehicle::MotionFunction motion, const Vec3& gravity) : system(gravity) {
    const Vec3 pin(r * std::cos(phi), 0.0, -r * std::sin(phi));
    const Vec3 piston(slider_position(phi), 0.0, 0.0);
    const Mat3 inertia = Vec3(0.01, 0.02, 0.02).asDiagonal();
    crank = system.add_body("crank", 1.0, inertia, bar_state(0.5 * pin, phi));
    rod = system.add_body("rod", 0.8, inertia, bar_state(0.5 * (pin + piston), 0.0));
    slider = system.add_body("slider", 2.0, inertia, bar_state(piston, 0.0));
    crank_pin =
        system.add_joint(vehicle::JointKind::revolute, "main bearing", vehicle::kGround, crank, hinge(Vec3::Zero()));
    big_end = system.add_joint(vehicle::JointKind::revolute, "big end", crank, rod, hinge(pin));
    // Spherical at one end and cylindrical at the guide: no redundant rows in space.
    small_end = system.add_joint(vehicle::JointKind::spherical, "small end", rod, slider, hinge(piston));
    guide = system.add_joint(vehicle::JointKind::prismatic, "guide", vehicle::kGround, slider,
                             slide(piston, Vec3::UnitX()));
    motor = system.add_motor("crank motor", crank_pin, std::move(motion));
    system.assemble(0.0);
  }
  static double slider_position(double phi) {
    return r * std::cos(phi) + std::sqrt(l * l - r * r * std::sin(phi) * std::sin(phi));
  }
  static double slider_slope(double phi) {  // dx/dφ
    const double s = std::sin(phi), c = std::cos(phi);
    return -r * s - r * r * s * c / std::sqrt(l * l - r * r * s * s);
  }
};

}  // namespace

TEST(SliderCrank, held_crank_carries_the_piston_force_by_virtual_work) {
  const double force = -700.0;
  for (const double phi : {0.3, 1.2, 2.4}) {
    SliderCrank mechanism(
        phi, [](double) { return vehicle::Motion{}; }, Vec3::Zero());
    mechanism.system.set_load(mechanism.slider, Vec3(force, 0, 0), Vec3::Zero());
    EXPECT_TRUE(mechanism.system.step(1e-3).ok);
    // T δφ + F δx = 0
    EXPECT_NEAR(mechanism.system.motor_force(mechanism.motor), -force * SliderCrank::slider_slope(phi), 1e-9);
    // The rod is a two-force member: the guide carries F tan β across.
    const double tan_beta = SliderCrank::r * std::sin(phi) /
                            std::sqrt(SliderCrank::l * SliderCrank::l - std::pow(SliderCrank::r * std::sin(phi), 2));
    const Mat3 axes = mechanism.system.joint(mechanism.guide).frame_a.axes;
    const Vec3 guide = axes * mechanism.system.reaction(mechanism.guide).force;
    EXPECT_NEAR(std::abs(guide.z()), std::abs(force * tan_beta), 1e-8);
    EXPECT_NEAR(guide.x(), 0.0, 1e-9);
  }
}

TEST(SliderCrank, driven_crank_gives_exact_kinematics_and_power_balance) {
  const double omega = 12.0, h = 5e-4;
  SliderCrank mechanism(
      0.3,
      [=](double t) {
        return vehicle::Motion{omega * t, omega};
      },
      Vec3(0, 0, -kStandardGravity));
  vehicle::System& system = mechanism.system;
  double work = 0.0;
  const double start = system.kinetic_energy() + system.gravity_energy();
  const int steps = 1500;  // about 1.4 revolutions
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(system.step(h).ok);
    work += system.motor_force(mechanism.motor) * omega * h;
  }
  const double phi = 0.3 + omega * system.time();
  const vehicle::BodyState& slider = system.body(mechanism.slider).state;
  EXPECT_NEAR(slider.position.x(), SliderCrank::slider_position(phi), 2e-12);
  EXPECT_NEAR(slider.velocity.x(), SliderCrank::slider_slope(phi) * omega, 1e-11);
  EXPECT_LT(system.max_violation(), 1e-12);
  const double gained = system.kinetic_energy() + system.gravity_energy() - start;
  EXPECT_NEAR(work, gained, 1e-4 * system.kinetic_energy());
}

// A platform on two parallel bars does not turn: every point moves on a circle. Four hinges about parallel axes give
// the loop three redundant rows.
TEST(FourBar, parallelogram_motor_torque_matches_statics_and_redundancy_is_flagged) {
  const double l = 0.6, w = 1.0, theta = 0.5, platform_mass = 20.0, bar_mass = 3.0;
  const Vec3 arm(l * std::sin(theta), 0.0, -l * std::cos(theta));
  const Mat3 inertia = Vec3(0.2, 0.3, 0.2).asDiagonal();
  vehicle::System system;
  const int left = system.add_body("left bar", bar_mass, inertia, bar_state(0.5 * arm, 0.0));
  const int right = system.add_body("right bar", bar_mass, inertia, bar_state(Vec3(w, 0, 0) + 0.5 * arm, 0.0));
  const int platform = system.add_body("platform", platform_mass, inertia, bar_state(Vec3(w / 2, 0, 0) + arm, 0.0));
  const int pivot =
      system.add_joint(vehicle::JointKind::revolute, "left pivot", vehicle::kGround, left, hinge(Vec3::Zero()));
  system.add_joint(vehicle::JointKind::revolute, "right pivot", vehicle::kGround, right, hinge(Vec3(w, 0, 0)));
  const int left_pin = system.add_joint(vehicle::JointKind::revolute, "left pin", left, platform, hinge(arm));
  const int right_pin =
      system.add_joint(vehicle::JointKind::revolute, "right pin", right, platform, hinge(Vec3(w, 0, 0) + arm));
  const int motor = system.add_motor("hold", pivot, [](double) { return vehicle::Motion{}; });
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 3);
  EXPECT_FALSE(system.redundant_names().empty());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(system.step(1e-3).ok);
  // Virtual work: T δθ_y raises the platform by l sin θ δθ, both bars by half of it; turning about +y lowers
  // +x.
  const double torque = -(platform_mass + bar_mass) * kStandardGravity * l * std::sin(theta);
  EXPECT_NEAR(system.motor_force(motor), torque, 1e-8 * std::abs(torque));
  const auto world = [&](int joint) { return Vec3(system.joint(joint).frame_a.axes * system.reaction(joint).force); };
  EXPECT_NEAR(world(left_pin).z() + world(right_pin).z(), platform_mass * kStandardGravity, 1e-8);
  EXPECT_NEAR(world(left_pin).y(), 0.0, 1e-6);
  EXPECT_LT(system.max_violation(), 1e-12);
  EXPECT_LT((system.body(platform).state.position - Vec3(w / 2, 0, 0) - arm).norm(), 1e-11);
}

TEST(Joints, universal_joint_turns_shafts_by_the_hooke_relation) {
  // tan φ₂ = tan φ₁ / cos β between two shafts at an angle β (φ₁ from the plane of the shafts' normal).
  const double beta = 0.5, omega = 10.0, h = 1e-4;
  vehicle::System system(Vec3::Zero());
  const Vec3 in = Vec3::UnitX(), out(std::cos(beta), 0.0, -std::sin(beta));
  vehicle::BodyState state;
  const Mat3 inertia = Vec3(0.1, 0.2, 0.3).asDiagonal();
  const int driver = system.add_body("input", 1.0, inertia, state);
  state.orientation = Quat(Eigen::AngleAxisd(beta, Vec3::UnitY()));
  const int driven = system.add_body("output", 1.0, inertia, state);
  const int bearing = system.add_joint(vehicle::JointKind::revolute, "input bearing", vehicle::kGround, driver,
                                       slide(Vec3::Zero(), in));
  vehicle::JointPlace cross;
  cross.axis = Vec3::UnitY();                    // fixed in the input shaft
  cross.second_axis = Vec3::UnitY().cross(out);  // fixed in the output shaft
  system.add_joint(vehicle::JointKind::universal, "cross", driver, driven, cross);
  const int far = system.add_joint(vehicle::JointKind::cylindrical, "output bearing", vehicle::kGround, driven,
                                   slide(Vec3::Zero(), out));
  (void)far;
  system.add_motor("motor", bearing, [=](double t) { return vehicle::Motion{omega * t, omega}; });
  system.assemble(0.0);
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    EXPECT_TRUE(system.step(h).ok);
    const double phi = omega * system.time();
    // Rate of the output: cos β / (1 − sin²β cos²φ), φ measured from the fork lying across the plane of the
    // shafts.
    const double reference = omega * std::cos(beta) / (1.0 - std::pow(std::sin(beta) * std::sin(phi), 2));
    worst = std::max(worst, std::abs(system.body(driven).state.angular_velocity.dot(out) - reference));
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(Joints, distance_joint_is_a_massless_rod) {
  // A ball on a rod of constant length: conical pendulum, ω² = g / (l cos θ).
  const double l = 1.1, theta = 0.7, m = 3.0;
  vehicle::System system;
  vehicle::BodyState state;
  state.position = Vec3(l * std::sin(theta), 0.0, -l * std::cos(theta));
  state.velocity = Vec3(0.0, std::sqrt(kStandardGravity / (l * std::cos(theta))) * state.position.x(), 0.0);
  const int ball = system.add_body("ball", m, 0.1 * Mat3::Identity(), state);
  vehicle::JointPlace place;
  place.second_point = state.position;
  const int rod = system.add_joint(vehicle::JointKind::distance, "rod", vehicle::kGround, ball, place);
  system.assemble(0.0);
  for (int i = 0; i < 2000; ++i) EXPECT_TRUE(system.step(1e-3).ok);
  EXPECT_NEAR(system.body(ball).state.position.norm(), l, 1e-12);
  EXPECT_NEAR(system.body(ball).state.position.z(), -l * std::cos(theta), 1e-5);
  EXPECT_NEAR(system.reaction(rod).force.norm(), m * kStandardGravity / std::cos(theta), 1e-4 * m * kStandardGravity);
}
