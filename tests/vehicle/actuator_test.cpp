// Actuators: motion, reaction on the other body and work against closed forms.
#include "vehicle/multibody/actuator.hpp"

#include <gtest/gtest.h>

#include "tests/protocol/fields_of.hpp"
#include "tests/vehicle/planar.hpp"

using namespace furrow;
using namespace furrow::testing;

TEST(Actuator, constant_force_on_a_slider_gives_speed_path_and_work) {
  const double m = 12.0, force = 30.0, h = 1e-3;
  vehicle::System system(Vec3::Zero());
  const int body = system.add_body("mass", m, Mat3::Identity(), {});
  const int rail = system.add_joint(vehicle::JointKind::prismatic, "rail", vehicle::kGround, body,
                                    slide(Vec3::Zero(), Vec3::UnitX()));
  const int actuator = system.add_joint_actuator("jack", rail);
  system.set_actuator(actuator, force);
  system.assemble(0.0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(system.step(h).ok);
  const double v = force / m, x = 0.5 * force / m;  // after 1 s
  EXPECT_NEAR(system.body(body).state.velocity.x(), v, 1e-12);
  EXPECT_NEAR(system.body(body).state.position.x(), x, 1e-12);
  EXPECT_NEAR(system.actuator(actuator).work, 0.5 * m * v * v, 1e-11);
  EXPECT_EQ(system.actuator(actuator).force, force);
}

TEST(Actuator, force_of_time_between_two_bodies_keeps_momentum_and_its_work_is_their_energy) {
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  const int a = system.add_body("a", 2.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), state);
  state.position = Vec3(1.0, 0.2, 0.1);
  const int b = system.add_body("b", 3.0, Vec3(0.2, 0.2, 0.4).asDiagonal(), state);
  const int jack = system.add_line_actuator("jack", a, b, Vec3::Zero(), state.position,
                                            [](double t) { return 5.0 * std::cos(3.0 * t); });
  const int twist = system.add_torque_actuator("twist", a, b, Vec3::UnitX(), [](double t) { return 0.2 * t; });
  system.assemble(0.0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_LT(system.momentum().norm(), 1e-12);
  EXPECT_LT(system.angular_momentum(Vec3(0.3, 0.1, -2.0)).norm(), 1e-12);
  // ∫ 0.2 t dt = 0.1 N m s about x, on inertias 0.1 and 0.2 kg m² about the same axis.
  EXPECT_NEAR(system.body(b).state.angular_velocity.x(), 0.1 / 0.2, 1e-9);
  EXPECT_NEAR(system.body(a).state.angular_velocity.x(), -0.1 / 0.1, 1e-9);
  const double work = system.actuator(jack).work + system.actuator(twist).work;
  EXPECT_NEAR(work, system.kinetic_energy(), 1e-10 * work);
}

TEST(Actuator, restored_actuators_continue_bit_for_bit) {
  const auto build = [](vehicle::System& system) {
    vehicle::BodyState state;
    state.position = Vec3(0.0, 0.0, -1.0);
    const int bob = system.add_body("bob", 2.0, 0.1 * Mat3::Identity(), state);
    const int pin = system.add_joint(vehicle::JointKind::revolute, "pin", vehicle::kGround, bob, hinge(Vec3::Zero()));
    system.add_joint_actuator("held", pin);
    system.add_joint_actuator("law", pin, [](double t) { return std::sin(t); });
    system.assemble(0.0);
  };
  vehicle::System original, copy;
  build(original);
  build(copy);
  original.set_actuator(0, 0.7);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(original.step(1e-3).ok);
  Archive archive;
  original.save(archive);
  copy.restore(archive);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(original.step(1e-3).ok && copy.step(1e-3).ok);
  Archive a, b;
  original.save(a);
  copy.save(b);
  EXPECT_EQ(a.arrays(), b.arrays());
  EXPECT_EQ(names_of<vehicle::ActuatorState>().size(), member_count<vehicle::ActuatorState>());
}
