// Shafts, gears, gyroscopic moments: closed forms, the same rotor as a body, moment balance, saved states.
#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/saved.hpp"
#include "tests/vehicle/planar.hpp"
#include "tests/vehicle/rate_controls.hpp"
#include "tests/verification/record.hpp"
#include "vehicle/driveline/gears.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::kGround, vehicle::RateControl, vehicle::RateMode;

TEST(Shaft, constant_torque_gives_speed_angle_and_work) {
  vehicle::System system;
  const int shaft = system.add_shaft("shaft", 0.5, kGround, Vec3::UnitX());
  const int drive = system.add_rate_row({"drive", {{shaft, 1.0}}, {}}, torque(20.0));
  system.assemble(0.0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_NEAR(system.shaft(shaft).state.speed, 40.0, 1e-11);
  EXPECT_NEAR(system.shaft(shaft).state.angle, 20.0, 1e-11);
  EXPECT_NEAR(system.rate_state(drive).work, 0.5 * 0.5 * 1600.0, 1e-10);
  EXPECT_NEAR(system.rate_state(drive).torque, 20.0, 1e-13);
}

TEST(Shaft, law_of_the_speed_is_of_second_order_and_stable_when_far_stiffer_than_the_step) {
  // J dΩ/dt = −c Ω: Ω = Ω₀ e^{−c t/J}
  const auto speed_after = [](double c, int steps) {
    vehicle::System system;
    const int shaft = system.add_shaft("shaft", 0.5, kGround, Vec3::UnitX(), 100.0);
    system.add_rate_law({"drag", {{shaft, 1.0}}, {}}, [c](auto u, double, auto torques) {
      torques[0] = {-c * u[0], c};
    });
    system.assemble(0.0);
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(1.0 / steps).ok);
    return system.shaft(shaft).state.speed;
  };
  const double reference = 100.0 * std::exp(-2.0 * 0.9);
  const double coarse = speed_after(0.9, 50) - reference, fine = speed_after(0.9, 100) - reference;
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
  EXPECT_LT(std::abs(speed_after(1e7, 100)), 100.0);
}

TEST(Gear, pair_accelerates_with_the_reduced_inertia_and_the_carrier_takes_the_difference) {
  // T = (J₁ + g² J₂) Ω̇₁; the motor's −T and the unbalanced torque of the teeth act on the housing, together −d/dt of
  // the momenta.
  const double J1 = 0.3, J2 = 1.7, g = 0.2, T = 12.0, h = 1e-3;
  vehicle::System system(Vec3::Zero());
  const int housing = system.add_body("housing", 50.0, Vec3(4, 5, 6).asDiagonal(), {});
  const int in = system.add_shaft("in", J1, housing, Vec3::UnitX());
  const int out = system.add_shaft("out", J2, housing, Vec3::UnitX());
  const int motor = system.add_rate_row({"motor", {{in, 1.0}}, {}}, torque(T));
  const int gear = vehicle::add_gear(system, "gear", in, out, g);
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(system.step(h).ok);
  // Relative speeds u and the housing's ω about x: Lagrange's equations of the three with total momentum zero.
  // J₁(u + ω) + J₂(g u + ω) + Jₕ ω = 0, energy ½ J₁(u+ω)² + ½ J₂(g u+ω)² + ½ Jₕ ω² = T φ
  const double Jh = 4.0, w_per_u = -(J1 + J2 * g) / (J1 + J2 + Jh);
  const double effective = J1 * std::pow(1 + w_per_u, 2) + J2 * std::pow(g + w_per_u, 2) + Jh * w_per_u * w_per_u;
  const double u = T / effective * 1.0;
  const double w = system.body(housing).state.angular_velocity.x();
  EXPECT_NEAR(w, w_per_u * u, 1e-10);
  EXPECT_NEAR(system.shaft(in).state.speed - w, u, 1e-10);
  EXPECT_NEAR(system.shaft(out).state.speed - w, g * u, 1e-10);
  verification::verify("gear pair in a free housing", "torque at the output, N m", system.rate_state(gear).torque,
                       J2 * (g + w_per_u) * u / 1.0, 1e-10, "Lagrange's equations");
  EXPECT_LT(system.angular_momentum(Vec3::Zero()).norm(), 1e-11);
  EXPECT_NEAR(system.rate_state(motor).work, system.kinetic_energy(), 1e-10 * system.kinetic_energy());
  EXPECT_NEAR(system.rate_state(gear).work, 0.0, 1e-10);
}

TEST(Gear, differential_splits_the_torque_exactly_and_planetary_by_willis) {
  vehicle::System system;
  const Vec3 y = Vec3::UnitY();
  const int box = system.add_shaft("box", 0.6, kGround, y);
  const int left = system.add_shaft("left", 0.4, kGround, y), right = system.add_shaft("right", 0.9, kGround, y);
  const int sun = system.add_shaft("sun", 0.1, kGround, y), ring = system.add_shaft("ring", 0.2, kGround, y);
  system.add_rate_row({"motor", {{box, 1.0}}, {}}, torque(100.0));
  const int differential = vehicle::add_differential(system, "differential", box, left, right);
  const double k = 2.5;
  const int set = system.add_rate_row({"planetary", {{sun, 1.0}, {ring, k}, {right, -(1.0 + k)}}, {}}, held(0.0));
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  const double h = 1e-3;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(system.step(h).ok);
  const double split = 0.5 * system.rate_state(differential).torque;  // on each side, constant over the second
  verification::verify("differential", "speed of the left shaft after 1 s, rad/s", system.shaft(left).state.speed,
                       split / 0.4, 1e-10, "half of the box's torque");
  verification::verify("differential", "speed of the box after 1 s, rad/s", system.shaft(box).state.speed,
                       (100.0 - 2 * split) / 0.6, 1e-10, "what the outputs leave");
  const double lambda = system.rate_state(set).torque;
  EXPECT_NEAR(system.shaft(sun).state.speed, lambda / 0.1, 1e-9);
  verification::verify("planetary gear", "speed of the ring after 1 s, rad/s", system.shaft(ring).state.speed,
                       k * lambda / 0.2, 1e-10, "Willis");
  EXPECT_NEAR(system.shaft(right).state.speed, (split - (1 + k) * lambda) / 0.9, 1e-9);
  const auto speed = [&](int shaft) { return system.shaft(shaft).state.speed; };
  EXPECT_NEAR(speed(left) + speed(right), 2.0 * speed(box), 1e-11);
  EXPECT_NEAR(speed(sun) + k * speed(ring), (1 + k) * speed(right), 1e-11);
}

TEST(Gear, a_loop_of_gears_is_flagged_and_ratio_zero_is_refused) {
  vehicle::System system;
  const int a = system.add_shaft("a", 1.0, kGround, Vec3::UnitX()),
            b = system.add_shaft("b", 1.0, kGround, Vec3::UnitX());
  vehicle::add_gear(system, "first", a, b, 0.5);
  const int second = vehicle::add_gear(system, "second", a, b, 0.5);
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 1);
  system.set_rate_control(second, {});
  system.recheck_rank();
  EXPECT_EQ(system.redundant_count(), 0);
  EXPECT_THROW(vehicle::add_gear(system, "none", a, b, 0.0), Error);
  EXPECT_THROW(system.add_shaft("no inertia", 0.0, kGround, Vec3::UnitX()), Error);
}

namespace {

// A frame on a ball joint carries a fast rotor along its x axis.
struct Gyroscope {
  static constexpr double J = 0.02, transverse = 0.012, speed = 150.0;
  vehicle::System system;
  int frame;
  explicit Gyroscope(bool as_body) {
    vehicle::BodyState state;
    state.position = Vec3(0.3, 0.0, 0.0);
    state.angular_velocity = Vec3(0.0, 0.1, 0.2);
    const double rotor_mass = 1.5;
    const Mat3 inertia = Vec3(0.03, 0.05, 0.04).asDiagonal();
    const Mat3 locked = inertia + Mat3(Vec3(0.0, transverse, transverse).asDiagonal());
    state.velocity = state.angular_velocity.cross(state.position);
    frame = system.add_body("frame", as_body ? 2.0 : 2.0 + rotor_mass, as_body ? inertia : locked, state);
    vehicle::JointPlace pivot;
    system.add_joint(vehicle::JointKind::spherical, "pivot", kGround, frame, pivot);
    if (as_body) {
      state.angular_velocity += speed * Vec3::UnitX();
      const int rotor = system.add_body("rotor", rotor_mass, Vec3(J, transverse, transverse).asDiagonal(), state);
      system.add_joint(vehicle::JointKind::revolute, "bearing", frame, rotor, slide(state.position, Vec3::UnitX()));
    } else {
      system.add_shaft("rotor", J, frame, Vec3::UnitX(), speed);
    }
    system.assemble(0.0);
  }
  Vec3 after(double end, int steps) {
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(system.step(end / steps).ok);
    return system.body(frame).state.position;
  }
};

}  // namespace

TEST(Shaft, gyroscope_moves_like_one_whose_rotor_is_a_body) {
  const Vec3 reference = Gyroscope(true).after(0.5, 40000);
  const double coarse = (Gyroscope(false).after(0.5, 500) - reference).norm();
  const double fine = (Gyroscope(false).after(0.5, 1000) - reference).norm();
  verification::verify("gyroscope, 0.5 s in 1000 steps", "distance to one whose rotor is a body, m", fine, 0.0, 1e-4,
                       "40,000 steps", 1.0);
  verification::verify("gyroscope", "error of steps twice as long", coarse / fine, 4.0, 0.1, "second order");
}

TEST(Shaft, free_carrier_with_a_rotor_keeps_its_angular_momentum_and_nearly_its_energy) {
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.angular_velocity = Vec3(0.5, -1.0, 2.0);
  const int body = system.add_body("carrier", 5.0, Vec3(0.3, 0.5, 0.4).asDiagonal(), state);
  system.add_shaft("rotor", 0.05, body, Vec3(1, 1, 0), 200.0);
  system.assemble(0.0);
  const Vec3 momentum = system.angular_momentum(Vec3::Zero());
  const double energy = system.kinetic_energy();
  for (int i = 0; i < 20000; ++i) ASSERT_TRUE(system.step(5e-4).ok);
  EXPECT_LT((system.angular_momentum(Vec3::Zero()) - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_NEAR(system.kinetic_energy(), energy, 1e-4 * energy);
}

TEST(Shaft, wheel_driven_over_a_shaft_takes_its_torque_and_the_whole_gets_no_moment) {
  // Chassis – shaft about x – conical gear – cross shaft about y – wheel on an inclined axle: all free in space.
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.angular_velocity = Vec3(0.3, -0.2, 0.4);
  const int chassis = system.add_body("chassis", 80.0, Vec3(20, 30, 40).asDiagonal(), state);
  const Vec3 axle = Vec3(0.05, 1.0, 0.08).normalized();
  state.position = Vec3(0.2, 0.9, 0.1);
  state.velocity = state.angular_velocity.cross(state.position);
  const int wheel = system.add_body("wheel", 10.0, Vec3(0.4, 0.7, 0.4).asDiagonal(), state);
  system.add_joint(vehicle::JointKind::revolute, "bearing", chassis, wheel, slide(state.position, axle));
  const int pinion = system.add_shaft("pinion", 0.5, chassis, Vec3::UnitX());
  const int cross = system.add_shaft("cross", 0.6, chassis, Vec3::UnitY());
  system.add_rate_row({"motor", {{pinion, 1.0}}, {}}, torque(30.0));
  vehicle::add_gear(system, "conical gear", pinion, cross, 0.2);
  const int hub = vehicle::add_shaft_to_body(system, "hub", cross, wheel, axle);
  system.assemble(0.0);
  EXPECT_EQ(system.redundant_count(), 0);
  const Vec3 about(0.7, -0.3, 2.0), momentum = system.angular_momentum(about), linear = system.momentum();
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(system.step(1e-3).ok);
    ASSERT_NEAR(system.rate_speed(hub), 0.0, 1e-10);
  }
  const Vec3 moved = system.momentum();
  EXPECT_LT((moved - linear).norm(), 1e-10);
  EXPECT_LT((system.angular_momentum(about) - momentum).norm(), 1e-10 * 80.0);
  EXPECT_GT(std::abs(system.shaft(pinion).state.speed), 50.0);
  EXPECT_LT(system.max_violation(), 1e-11);
}

TEST(Shaft, restored_shafts_continue_bit_for_bit) {
  const auto build = [](vehicle::System& system) {
    const int body = system.add_body("carrier", 5.0, Vec3(0.3, 0.5, 0.4).asDiagonal(), {});
    const int a = system.add_shaft("a", 0.05, body, Vec3(1, 1, 0), 20.0);
    const int b = system.add_shaft("b", 0.07, body, Vec3(1, 0, 0), 0.0);
    vehicle::add_gear(system, "gear", a, b, 0.7);
    RateControl brake;
    brake.mode = RateMode::hold;
    brake.lower = -0.4, brake.upper = 0.4;
    system.add_rate_row({"brake", {{b, 1.0}}, {}}, brake);
    system.assemble(0.0);
  };
  vehicle::System original, copy;
  build(original);
  build(copy);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(original.step(1e-3).ok);
  original.set_rate_factor(0, 1, -0.9);
  copy.restore(saved(original));
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(original.step(1e-3).ok && copy.step(1e-3).ok);
  EXPECT_EQ(saved(copy).arrays(), saved(original).arrays());
  EXPECT_EQ(names_of<vehicle::ShaftState>().size(), member_count<vehicle::ShaftState>());
  EXPECT_EQ(names_of<RateControl>().size(), member_count<RateControl>());
  EXPECT_EQ(names_of<vehicle::RateState>().size(), member_count<vehicle::RateState>());
}
