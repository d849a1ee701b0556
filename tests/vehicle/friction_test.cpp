// Brakes and clutches: holding and slipping as a set-valued law, against closed forms, equal for every step.
#include <algorithm>

#include <gtest/gtest.h>

#include "protocol/core/constants.hpp"
#include "tests/saved.hpp"
#include "tests/vehicle/planar.hpp"
#include "tests/vehicle/rate_controls.hpp"
#include "vehicle/driveline/friction_coupling.hpp"
#include "vehicle/driveline/gears.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::FrictionCoupling, vehicle::kGround, vehicle::RateControl, vehicle::RateMode;

namespace {

// A wheel hinged about y with a weight on an arm, held by a brake.
struct HeldArm {
  static constexpr double m = 40.0, arm = 0.5;
  vehicle::System system;
  int body;
  FrictionCoupling brake;
  explicit HeldArm(double capacity)
      : body(system.add_body("arm", m, Vec3(0.3, 0.4, 0.3).asDiagonal(), bar_state(Vec3(arm, 0, 0), 0.0))),
        brake(FrictionCoupling::brake(system, "brake", kGround, body, Vec3::UnitY(), capacity)) {
    system.add_joint(vehicle::JointKind::revolute, "hinge", kGround, body, hinge(Vec3::Zero()));
    system.assemble(0.0);
    brake.engage(system, 1.0);
  }
};

}  // namespace

TEST(Brake, holds_a_weight_for_ten_seconds_without_creep_and_alike_at_two_steps) {
  const double weight = HeldArm::m * kStandardGravity * HeldArm::arm;
  for (const double h : {1e-3, 4e-5}) {
    HeldArm held(1.01 * weight);
    const int steps = h < 1e-4 ? 50000 : 10000;  // 2 s and 10 s
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(held.system.step(h).ok);
    EXPECT_TRUE(held.brake.holds(held.system));
    EXPECT_LT(std::abs(held.system.body(held.body).state.position.z()), 1e-12) << h;
    EXPECT_NEAR(held.brake.torque(held.system), -weight, 1e-9 * weight) << h;
    EXPECT_NEAR(held.brake.heat(held.system), 0.0, 1e-12) << h;
  }
}

TEST(Brake, hold_that_is_resumed_continues_bit_for_bit) {
  HeldArm original(250.0), copy(250.0);
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(original.system.step(1e-3).ok);
  copy.brake.engage(copy.system, 0.0);  // the saved state contains the engagement
  copy.system.restore(saved(original.system));
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(original.system.step(1e-3).ok && copy.system.step(1e-3).ok);
  EXPECT_EQ(saved(copy.system).arrays(), saved(original.system).arrays());
  EXPECT_TRUE(copy.brake.holds(copy.system));
}

TEST(Brake, too_weak_by_one_percent_slips_with_its_capacity) {
  const double weight = HeldArm::m * kStandardGravity * HeldArm::arm;
  HeldArm held(0.99 * weight);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(held.system.step(1e-3).ok);
  EXPECT_FALSE(held.brake.holds(held.system));
  EXPECT_NEAR(held.brake.torque(held.system), -0.99 * weight, 1e-9 * weight);
  // (I + m a²) dω/dt = 0.01 m g a near the horizontal.
  const double rate = 0.01 * weight / (0.4 + HeldArm::m * HeldArm::arm * HeldArm::arm);
  EXPECT_NEAR(held.system.body(held.body).state.angular_velocity.y(), rate * 0.1, 1e-6);
}

TEST(Brake, stops_a_flywheel_in_the_time_and_with_the_heat_of_the_closed_form_and_then_holds) {
  const double J = 0.8, speed = 50.0, T = 100.0;  // stops after 0.4 s
  for (const double h : {1e-3, 4e-5}) {
    vehicle::System system;
    const int shaft = system.add_shaft("flywheel", J, kGround, Vec3::UnitY(), speed);
    const int fixed = system.add_shaft("frame", 1.0, kGround, Vec3::UnitY());
    system.add_rate_row({"frame held", {{fixed, 1.0}}, {}}, held(0.0));
    const FrictionCoupling brake = FrictionCoupling::clutch(system, "brake", shaft, fixed, 2.0 * T);
    system.assemble(0.0);
    brake.engage(system, 0.5);
    const int steps = static_cast<int>(std::lround(0.5 / h));
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(system.step(h).ok);
      ASSERT_NEAR(system.shaft(shaft).state.speed, std::max(0.0, speed - T / J * system.time()), 1e-9);
    }
    EXPECT_EQ(brake.holds(system), true);
    EXPECT_NEAR(brake.heat(system), 0.5 * J * speed * speed, 1e-9 * 1000.0);
    EXPECT_NEAR(system.shaft(shaft).state.angle, 0.5 * speed * speed * J / T, 1e-3 * 10.0);
  }
}

TEST(Clutch, locks_two_flywheels_at_their_common_momentum_and_slips_again_above_its_capacity) {
  const double J1 = 0.5, J2 = 1.5, T = 30.0;
  vehicle::System system;
  const int a = system.add_shaft("a", J1, kGround, Vec3::UnitX(), 80.0);
  const int b = system.add_shaft("b", J2, kGround, Vec3::UnitX());
  const int motor = system.add_rate_row({"motor", {{a, 1.0}}, {}});
  const FrictionCoupling clutch = FrictionCoupling::clutch(system, "clutch", a, b, T);
  system.assemble(0.0);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_NEAR(system.shaft(a).state.speed, 80.0, 1e-12);  // open
  clutch.engage(system, 1.0);
  for (int i = 0; i < 1100; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  // Slip ends after 80 / (T/J₁ + T/J₂) = 1 s.
  EXPECT_TRUE(clutch.holds(system));
  EXPECT_NEAR(system.shaft(a).state.speed, 20.0, 1e-10);
  EXPECT_NEAR(system.shaft(b).state.speed, 20.0, 1e-10);
  EXPECT_NEAR(clutch.heat(system), 0.5 * J1 * 6400.0 - 0.5 * (J1 + J2) * 400.0, 1e-8);
  // A motor torque M on a needs M J₂/(J₁ + J₂) through the clutch: 39 N m hold, 41 N m slip.
  system.set_rate_control(motor, torque(39.0));
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_TRUE(clutch.holds(system));
  EXPECT_NEAR(clutch.torque(system), -39.0 * 0.75, 1e-9);
  system.set_rate_control(motor, torque(41.0));
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_FALSE(clutch.holds(system));
  EXPECT_NEAR(clutch.torque(system), -T, 1e-9);
  EXPECT_GT(clutch.slip(system), 0.0);
}

TEST(Clutch, locking_differential_carries_its_capacity_across_and_no_more) {
  // Both outputs braked: left holds, right turns. The clutch between them slips and moves its torque
  // from right to left.
  vehicle::System system;
  const Vec3 y = Vec3::UnitY();
  const int box = system.add_shaft("box", 0.6, kGround, y), left = system.add_shaft("left", 0.4, kGround, y);
  const int right = system.add_shaft("right", 0.4, kGround, y);
  const int drive = system.add_rate_row({"drive", {{box, 1.0}}, {}}, torque(500.0));
  (void)drive;
  vehicle::add_differential(system, "differential", box, left, right);
  const FrictionCoupling lock = FrictionCoupling::clutch(system, "lock", left, right, 100.0);
  const int road = system.add_rate_row({"road", {{left, 1.0}}, {}}, held(0.0));
  system.assemble(0.0);
  lock.engage(system, 1.0);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_FALSE(lock.holds(system));
  // λ on each side; right: 0.4 Ω̇ = λ − 100; box: 0.6 Ω̇/2 = 500 − 2λ; left held: road = −(λ + 100)
  const double lambda = (500.0 + 0.75 * 100.0) / (2.0 + 0.75);
  EXPECT_NEAR(system.rate_state(road).torque, -(lambda + 100.0), 1e-8);
  EXPECT_NEAR(system.shaft(right).state.speed, (lambda - 100.0) / 0.4 * 0.2, 1e-8);
}

TEST(Lock, creeps_with_its_share_of_the_torque_and_takes_nothing_where_brakes_hold_both_outputs) {
  const double J = 0.4, T = 60.0, capacity = 100.0;
  for (const double h : {1e-3, 4e-5}) {
    vehicle::System system;
    const Vec3 y = Vec3::UnitY();
    const int left = system.add_shaft("left", J, kGround, y, 20.0),
              right = system.add_shaft("right", J, kGround, y, 20.0);
    const FrictionCoupling lock = FrictionCoupling::lock(system, "lock", left, right, capacity);
    const int road = system.add_rate_row({"road", {{left, 1.0}}, {}}, torque(-T));
    system.assemble(0.0);
    lock.engage(system, 1.0);
    const int steps = static_cast<int>(std::lround(0.1 / h));
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(system.step(h).ok);
    // Both turn equally: J Ω̇ = −T + λ = −λ.
    const double creep = -vehicle::kLockCreep * 0.5 * T / capacity;
    EXPECT_TRUE(lock.holds(system));
    EXPECT_NEAR(lock.torque(system), 0.5 * T, 1e-9 * T);
    EXPECT_NEAR(lock.slip(system), creep, 1e-9);
    EXPECT_NEAR(system.shaft(right).state.speed, 20.0 - 0.5 * T / J * 0.1, 1e-4);
    EXPECT_NEAR(lock.heat(system), -0.5 * T * creep * 0.1, 0.02 * 0.5 * T * std::abs(creep) * 0.1);
    system.set_rate_control(road, torque(0.0));
    for (const int shaft : {left, right}) system.add_rate_row({"brake", {{shaft, 1.0}}, {}}, held(0.0));
    system.assemble(system.time());
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(system.step(h).ok);
    EXPECT_NEAR(lock.torque(system), 0.0, 1e-9);
    EXPECT_NEAR(system.shaft(left).state.speed, 0.0, 1e-12);
  }
}

TEST(Brake, four_brakes_on_a_locked_chain_hold_together_and_share_the_load_evenly) {
  vehicle::System system;
  const int shaft = system.add_shaft("shaft", 0.4, kGround, Vec3::UnitY());
  std::vector<int> brakes;
  for (int k = 0; k < 4; ++k) {
    RateControl control;
    control.mode = RateMode::hold;
    control.upper = 30.0, control.lower = -30.0;
    brakes.push_back(system.add_rate_row({"brake", {{shaft, 1.0}}, {}}, control));
  }
  const int motor = system.add_rate_row({"motor", {{shaft, 1.0}}, {}}, torque(100.0));
  system.assemble(0.0);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_LT(std::abs(system.shaft(shaft).state.speed), 1e-13);
  for (const int brake : brakes) EXPECT_NEAR(system.rate_state(brake).torque, -25.0, 1e-6);
  system.set_rate_control(motor, torque(130.0));
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(system.step(1e-3).ok);
  EXPECT_NEAR(system.shaft(shaft).state.speed, 10.0 / 0.4 * 0.1, 1e-9);
}

TEST(Brake, works_between_an_upright_that_swings_and_its_wheel_without_turning_the_whole) {
  // Two bodies free in space on a common bearing: the brake does not change their angular momentum.
  vehicle::System system(Vec3::Zero());
  vehicle::BodyState state;
  state.angular_velocity = Vec3(0.4, 0.3, -0.2);
  const int upright = system.add_body("upright", 20.0, Vec3(0.3, 0.4, 0.2).asDiagonal(), state);
  state.angular_velocity += 30.0 * Vec3::UnitY();
  const int wheel = system.add_body("wheel", 30.0, Vec3(1.0, 2.0, 1.0).asDiagonal(), state);
  const int bearing = system.add_joint(vehicle::JointKind::revolute, "bearing", upright, wheel, hinge(Vec3::Zero()));
  const FrictionCoupling brake = FrictionCoupling::brake(system, "brake", upright, wheel, Vec3::UnitY(), 60.0);
  system.assemble(0.0);
  const Vec3 momentum = system.angular_momentum(Vec3::Zero());
  const double energy = system.kinetic_energy();
  brake.engage(system, 1.0);
  double angle = 0.0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(system.step(1e-3).ok);
    if (i == 999) angle = system.coordinate(bearing).value;
  }
  EXPECT_TRUE(brake.holds(system));
  EXPECT_NEAR(system.coordinate(bearing).value, angle, 1e-9);  // two seconds of tumbling later
  EXPECT_LT((system.angular_momentum(Vec3::Zero()) - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_NEAR(brake.heat(system), energy - system.kinetic_energy(), 2e-3 * energy);
}
