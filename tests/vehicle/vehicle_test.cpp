// Vehicles built from their files: counts, balances of momentum, reactions, saved states.
#include "vehicle/parts/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/saved.hpp"
#include "tests/vehicle/shipped.hpp"
#include "tests/vehicle/verification/simple_ground.hpp"
#include "vehicle/driveline/gearbox.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::Vehicle, vehicle::VehicleInputs;

namespace {

/// A tire as a vertical spring and a force along the ground that follows its slip speed.
Wrench simple_tire(const RimState& rim, double radius, double stiffness) {
  Wrench wrench;
  const Vec3 arm(0, 0, -rim.position.z());
  const Vec3 sliding = rim.velocity + rim.angular_velocity.cross(arm);
  const double load = std::max(0.0, stiffness * (radius - rim.position.z()) - 0.01 * stiffness * rim.velocity.z());
  wrench.force = Vec3(-0.9 * load * std::tanh(2.0 * sliding.x()), -0.9 * load * std::tanh(2.0 * sliding.y()), load);
  wrench.moment = arm.cross(wrench.force);
  return wrench;
}

void put_on_ground(Vehicle& car, double radius) {
  double lowest = 1e300;
  for (int k = 0; k < car.wheel_count(); ++k) lowest = std::min(lowest, car.rim(k).position.z());
  car.move(Vec3(0, 0, radius - 0.01 - lowest));
}

void drive(Vehicle& car, int steps, double radius, double stiffness, double h = 1e-3) {
  for (int i = 0; i < steps; ++i) {
    for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, simple_tire(car.rim(k), radius, stiffness));
    const Outcome outcome = car.step(h);
    ASSERT_TRUE(outcome.ok) << outcome.message("vehicle") << " at step " << i;
  }
}

}  // namespace

// 19 bodies with 100 rows and no redundancy leave 14 freedoms: 6 of the chassis, 4 wheels that bounce and 4 that spin.
// The crank in front of the converter is one more.
TEST(Vehicle, hmmwv_with_pitman_arm_has_19_bodies_100_rows_and_14_and_1_freedoms_and_does_not_drift) {
  Vehicle car(shipped("hmmwv.json"));
  EXPECT_EQ(car.system().body_count(), 19);
  EXPECT_EQ(car.system().constraint_count(), 100);
  EXPECT_EQ(car.system().redundant_count(), 0);
  EXPECT_EQ(6 * car.system().body_count() - car.system().constraint_count(), 14);
  EXPECT_EQ(car.freedoms(), 15);
  // Published masses: 2086.52 + 4 × 63.933 + 4 × 18.8 + 3.681 + 1.605 kg.
  EXPECT_NEAR(car.mass(), 2422.74, 0.01);
  put_on_ground(car, 0.4673);
  VehicleInputs inputs;
  inputs.throttle = 0.5;
  inputs.steering = 0.7;
  car.set_inputs(inputs);
  double worst = 0.0;
  for (int i = 0; i < 8; ++i) {
    drive(car, 100, 0.4673, 3e5);
    worst = std::max(worst, car.system().max_violation());
  }
  EXPECT_LT(worst, 1e-11);
  EXPECT_GT(car.origin().x(), 0.05);
  EXPECT_GT(car.steering(0)->input(car.system().time()).value, 0.69);
}

TEST(Vehicle, every_template_leaves_the_wheels_their_travel) {
  // Buggy: 6 + 2 wishbones + heave and roll of the axle + 4 spins; 7 shafts less gearbox, 2 gears, differential, 2
  // hubs.
  Vehicle buggy(shipped("buggy.json"));
  EXPECT_EQ(buggy.freedoms(), 6 + 2 + 2 + 4 + 7 - 6);
  // Rover: 6 + 2 sprung arms + 2 beams + 6 spins, each with the rotor of its motor.
  Vehicle rover(shipped("rover.json"));
  EXPECT_EQ(rover.freedoms(), 6 + 2 + 2 + 6);
  EXPECT_EQ(rover.wheel_count(), 6);
  EXPECT_EQ(rover.wheel(4).carrier, rover.wheel(2).carrier);
}

TEST(Vehicle, drive_shift_steering_and_brakes_leave_momentum_and_angular_momentum_of_the_whole_alone) {
  for (const char* name : {"hmmwv.json", "buggy.json", "rover.json"}) {
    Vehicle car(shipped(name), Vec3::Zero());
    vehicle::System& system = car.system();
    const Vec3 about(1.0, 2.0, -0.5);
    const Vec3 momentum = system.momentum(), angular = system.angular_momentum(about);
    VehicleInputs inputs;
    inputs.throttle = 1.0;
    inputs.steering = 0.5;
    car.set_inputs(inputs);
    double largest = 0.0, wheels = 0.0, violation = 0.0;
    for (int i = 0; i < 1500; ++i) {
      if (i == 800) {
        inputs.throttle = 0.0;
        car.set_inputs(inputs);
      }
      if (i == 900) {
        inputs.brake = 0.5;
        car.set_inputs(inputs);
      }
      const Outcome outcome = car.step(1e-3);
      ASSERT_TRUE(outcome.ok) << name << ": " << outcome.message("vehicle") << " at step " << i;
      largest = std::max(largest, (system.angular_momentum(about) - angular).norm());
      violation = std::max(violation, system.max_violation());
      if (i == 790)
        for (int k = 0; k < car.wheel_count(); ++k) {
          const vehicle::Body& rim = system.body(car.wheel(k).spindle);
          wheels += rim.inertia(1, 1) * std::abs((rim.R.transpose() * rim.state.angular_velocity).y());
        }
    }
    EXPECT_GT(wheels, 0.0) << name;
    EXPECT_LT(largest, 1e-9 * wheels) << name;
    EXPECT_LT((system.momentum() - momentum).norm(), 1e-12 * car.mass()) << name;
    EXPECT_LT(violation, 1e-11) << name;
    EXPECT_TRUE(!car.brake(0) || car.brake(0)->holds(system)) << name;
  }
}

// Over a step with constant wrenches: ΔL = h Σ (x̄ × F + M), x̄ the mean of the positions before and after. Gravity
// acts in each body's centre of mass.
TEST(Vehicle, moments_of_the_whole_vehicle_about_the_ground_balance_at_every_step) {
  for (const char* name : {"hmmwv.json", "hmmwv_tr.json", "buggy.json"}) {
    Vehicle car(shipped(name));
    vehicle::System& system = car.system();
    const double h = 1e-3;
    put_on_ground(car, 0.4673);
    VehicleInputs inputs;
    inputs.throttle = 1.0;
    inputs.steering = 0.3;
    double worst = 0.0, scale = 0.0;
    for (int i = 0; i < 600; ++i) {
      if (i == 400) inputs = {0.0, 1.0, -0.5};
      car.set_inputs(inputs);
      std::vector<Vec3> before, forces, moments;
      for (int b = 0; b < system.body_count(); ++b) before.push_back(system.body(b).state.position);
      for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, simple_tire(car.rim(k), 0.4673, 3e5));
      for (int b = 0; b < system.body_count(); ++b) {
        forces.push_back(system.body(b).force + system.body(b).mass * system.gravity());
        moments.push_back(system.body(b).moment);
      }
      const Vec3 start = system.angular_momentum(Vec3::Zero());
      ASSERT_TRUE(car.step(h).ok) << name << " at step " << i;
      Vec3 sum = Vec3::Zero();
      for (int b = 0; b < system.body_count(); ++b) {
        const Vec3 moment = (0.5 * (before[b] + system.body(b).state.position)).cross(forces[b]) + moments[b];
        sum += moment;
        scale = std::max(scale, moment.norm());
      }
      worst = std::max(worst, ((system.angular_momentum(Vec3::Zero()) - start) / h - sum).norm());
    }
    EXPECT_GT(scale, 1e3);
    EXPECT_LT(worst, 1e-10 * scale) << name;  // N m
  }
}

// Without a driveline nothing moves once it has swayed: round-off then comes from the loads and not from speeds.
TEST(Vehicle, braked_on_a_slope_it_comes_to_rest_and_goes_on) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  spec.driveline = {};
  Vehicle car(spec, gravity_on_slope(0.2));
  std::vector<GroundContact> contacts(car.wheel_count());
  put_on_ground(car, contacts.front());
  VehicleInputs inputs;
  inputs.brake = 1.0;
  car.set_inputs(inputs);
  for (int i = 0; i < 7000; ++i) {
    for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, contacts[k].stick(car.rim(k), 1e-3));
    const Outcome outcome = car.step(1e-3);
    ASSERT_TRUE(outcome.ok) << outcome.message("HMMWV") << " at step " << i;
  }
  EXPECT_LT(car.system().body(car.chassis()).state.velocity.norm(), 1e-7);
}

TEST(Vehicle, a_slipping_brake_takes_its_torque_from_the_spindle) {
  Vehicle car(shipped("hmmwv.json"), Vec3::Zero());
  vehicle::System& system = car.system();
  VehicleInputs inputs;
  inputs.brake = 0.1;
  // Neutral, spun up by an outer couple.
  inputs.selector = vehicle::Selector::neutral;
  car.set_wrench(0, {Vec3::Zero(), Vec3(0, 1000.0, 0)});
  car.set_inputs(inputs);
  ASSERT_TRUE(car.step(1e-3).ok);
  EXPECT_NEAR(car.brake(0)->torque(system), -400.0, 1e-9);
}

TEST(Vehicle, a_tire_s_mass_is_added_to_the_rim) {
  Vehicle car(shipped("hmmwv.json"));
  const double mass = car.mass();
  MassProperties tire;
  tire.mass = 4.8;
  tire.inertia = Vec3(0.4, 0.78, 0.4).asDiagonal();
  for (int k = 0; k < car.wheel_count(); ++k) car.add_tire_mass(k, tire);
  EXPECT_NEAR(car.mass(), mass + 4 * 4.8, 1e-9);
  EXPECT_NEAR(car.system().body(car.wheel(3).spindle).inertia(1, 1), 0.07352 + 0.6243 + 0.78, 1e-12);
  EXPECT_EQ(car.rim(1).position, car.system().body(car.wheel(1).spindle).state.position);
}

TEST(Vehicle, a_rover_turns_on_the_spot_by_its_motors) {
  Vehicle rover(shipped("rover.json"));
  put_on_ground(rover, 0.058);
  VehicleInputs inputs;
  inputs.steering = 1.0;
  rover.set_inputs(inputs);
  drive(rover, 2000, 0.058, 1e4);
  const Vec3 spin = rover.system().body(rover.chassis()).state.angular_velocity;
  EXPECT_GT(spin.z(), 0.1);  // rad/s, to the left
  EXPECT_LT(rover.system().body(rover.chassis()).state.velocity.norm(), 0.1);
  EXPECT_GT(rover.drive().work(rover.system()), 0.0);
}

TEST(Vehicle, a_buggy_starts_shifts_and_stops) {
  Vehicle buggy(shipped("buggy.json"));
  put_on_ground(buggy, 0.3045);
  VehicleInputs inputs;
  inputs.throttle = 1.0;
  buggy.set_inputs(inputs);
  drive(buggy, 6000, 0.3045, 2e5);
  EXPECT_GT(buggy.system().body(0).state.velocity.x(), 8.0);
  EXPECT_GE(buggy.drive().gearbox()->gear(), 1);
  inputs = {0.0, 1.0};
  buggy.set_inputs(inputs);
  drive(buggy, 5000, 0.3045, 2e5);
  EXPECT_LT(std::abs(buggy.system().body(0).state.velocity.x()), 0.1);
}

TEST(Vehicle, resumed_during_a_shift_continues_bit_for_bit) {
  const auto prepare = [](Vehicle& car) {
    put_on_ground(car, 0.4673);
    VehicleInputs inputs;
    inputs.throttle = 1.0;
    inputs.steering = 0.4;
    car.set_inputs(inputs);
  };
  Vehicle original(shipped("hmmwv.json")), copy(shipped("hmmwv.json"));
  prepare(original);
  int steps = 0;
  while (!original.drive().gearbox()->shifting() && steps++ < 8000) drive(original, 1, 0.4673, 3e5);
  ASSERT_TRUE(original.drive().gearbox()->shifting());
  drive(original, 50, 0.4673, 3e5);
  copy.restore(saved(original));
  drive(original, 500, 0.4673, 3e5);
  drive(copy, 500, 0.4673, 3e5);
  EXPECT_EQ(saved(copy).arrays(), saved(original).arrays());
  EXPECT_EQ(copy.drive().gearbox()->gear(), 1);
}
