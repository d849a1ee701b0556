// The HMMWV on hard ground against estimates from its engine map, its gears and the ground's friction: steady speeds at
// full throttle on the level and uphill, stopping distance, turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/vehicle/verification/drive.hpp"
#include "tests/verification/record.hpp"
#include "vehicle/analysis/wheel_angles.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::Table, vehicle::VehicleInputs;

namespace {

constexpr DriveOptions kGrip{.slip_width = 0.4, .step = 1e-3};

/// Speed of the wheels at which full throttle balances a force F, m/s, radius r, in a gear. With the speeds u of the
/// crank and R u of the turbine, and the ratio i of the wheels' over the turbine's:
///   T_e(u) = (u/K(R))²,   T(R) (u/K(R))² = i F r,   v = R u i r
/// Near R = 1 the converter's torque is the straight line of torque_converter.hpp.
double balanced_speed(const vehicle::DrivelineSpec& line, int gear, double force, double radius) {
  const Table full("torque", line.engine->torque), losses("losses", line.engine->losses);
  const Table capacity("capacity", line.converter->capacity), ratio("ratio", line.converter->torque_ratio);
  const double i = line.gearbox->ratios[gear - 1] * line.gears[1].ratio, blend = 0.02;
  const double rpm = std::numbers::pi / 30.0;
  const auto taken = [&](double u, double R) {  // from the crank
    const double edge = std::pow(u / capacity.value(std::min(R, 1.0 - blend)), 2);
    return R <= 1.0 - blend ? edge : edge * (1.0 - R) / blend;
  };
  double low = 0.0, high = 1.0;  // of R
  double u = 0.0;
  for (int k = 0; k < 60; ++k) {
    const double R = 0.5 * (low + high);
    double slow = 400.0 * rpm,
           fast = 2700.0 * rpm;  // the crank's speed at which the converter takes the engine's torque
    for (int m = 0; m < 60; ++m) {
      u = 0.5 * (slow + fast);
      (full.value(u / rpm) + losses.value(u / rpm) > taken(u, R) ? slow : fast) = u;
    }
    (ratio.value(R) * taken(u, R) > i * force * radius ? low : high) = R;
  }
  return low * u * i * radius;
}

struct Ascent {
  double made_good = 0.0, wheels = 0.0, speed = 0.0;  // m/s: distance over time; at the end
  int gear = 0, changes = 0;
};

/// At full throttle from rest.
Ascent climbed(double grade, double duration) {
  DriveOptions options = kGrip;
  options.grade = grade;
  Drive d("hmmwv.json", options);
  Ascent done;
  for (long i = 0; i < d.steps(duration); ++i) {
    VehicleInputs inputs = full_throttle();
    const Vec3 forward = d.chassis().R * Vec3::UnitX();
    inputs.steering = std::clamp(-2.0 * std::atan2(forward.y(), forward.x()) - 0.05 * d.car.origin().y(), -1.0, 1.0);
    const int before = d.car.drive().gearbox()->gear();
    d.step(inputs);
    done.changes += before != d.car.drive().gearbox()->gear();
  }
  done.made_good = d.car.origin().x() / duration;
  done.speed = d.speed(), done.wheels = d.wheel_speed();
  done.gear = d.car.drive().gearbox()->gear() + 1;
  return done;
}

struct Turn {
  double radius = 0.0, expected = 0.0, lateral = 0.0, steer = 0.0;  // m, m, m/s², rad
};

/// One angle of the steering wheel, held until the turn is steady.
Turn turn(double speed, double steering) {
  Drive d("hmmwv.json", kGrip);
  d.begin(speed);
  double sum_v = 0.0, sum_rate = 0.0, cot = 0.0, integral = 0.0;
  const long count = d.steps(6.0), last = d.steps(2.0);
  for (long i = 0; i < count; ++i) {
    const double error = speed - d.speed();
    integral = std::clamp(integral + error * d.options.step, -1.0, 1.0);
    VehicleInputs inputs;
    inputs.throttle = std::clamp(0.3 * error + 0.3 * integral, 0.0, 1.0);
    inputs.steering = steering * std::clamp(i * d.options.step - 0.5, 0.0, 1.0);
    d.step(inputs);
    if (i < count - last) continue;
    sum_v += d.speed() / last, sum_rate += d.chassis().state.angular_velocity.z() / last;
    for (const int k : {0, 1}) cot += 0.5 / last / std::tan(vehicle::steer_angle(d.axle(k)));
  }
  const double base = d.car.rim(0).position.x() - d.car.rim(2).position.x();
  const double wheelbase = std::hypot(base, d.car.rim(0).position.y() - d.car.rim(2).position.y());
  return {sum_v / sum_rate, wheelbase * cot, sum_v * sum_rate, std::atan(1.0 / cot)};
}

}  // namespace

// Uphill the wheels take m g sin θ. The mean speed over 20 s from rest is less than the steady speed.
TEST(Driving, steady_speeds_at_full_throttle_are_those_of_map_converter_and_gears) {
  int highest = 0;
  for (const double grade : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
    const Ascent done = climbed(grade, 20.0);
    const Drive d("hmmwv.json", {.grade = grade});
    const double force = d.car.mass() * kStandardGravity * grade / std::sqrt(1.0 + grade * grade);
    const double expected = balanced_speed(d.car.spec().driveline, done.gear, force, d.car.rim(0).position.z());
    const std::string name = "HMMWV at full throttle, slope of " + verification::brief(100.0 * grade) +
                             " %, 20 s, in gear " + std::to_string(done.gear);
    verification::verify(name, "speed of the wheels at the end, m/s", done.wheels, expected, 0.02,
                         "engine map, converter and gears");
    verification::verify(name, "speed made good, m/s", done.made_good, expected, 0.5, "the same, from the start");
    EXPECT_GT(done.made_good, 1.0) << grade;
    EXPECT_EQ(done.changes, done.gear - 1) << grade;
    highest = std::max(highest, done.gear);
  }
  EXPECT_EQ(highest, 3);
}

TEST(Driving, stops_within_the_distance_of_its_friction) {
  Drive d("hmmwv.json", kGrip);
  d.begin(15.0);
  VehicleInputs inputs;
  inputs.brake = 1.0;
  const double start = d.car.origin().x(), speed = d.speed();
  for (long i = 0; i < d.steps(5.0) && d.speed() > 0.1; ++i) d.step(inputs);
  EXPECT_LT(d.speed(), 0.11);
  const double friction = d.contacts[0].friction;
  verification::verify("HMMWV brakes from 15 m/s on friction 0.9", "distance, m", d.car.origin().x() - start,
                       speed * speed / (2.0 * friction * kStandardGravity), 0.1, "v^2/(2 mu g)");
}

// All tires push in proportion to their load, so both axles have the same slip angle, and the angles give the radius at
// any speed, except for steering by the wheels' travel.
TEST(Driving, turns_on_the_radius_of_its_wheels_angles) {
  Turn slow, fast;
  for (const double speed : {2.0, 5.0, 8.0}) {
    const Turn t = turn(speed, 0.3);
    (speed < 3.0 ? slow : fast) = t;
    verification::verify("HMMWV turns at " + verification::brief(speed) + " m/s", "radius, m", t.radius, t.expected,
                         0.05, "wheelbase over tan of the steer angles");
  }
  const double gradient = ((fast.steer - fast.steer * fast.expected / fast.radius) -
                           (slow.steer - slow.steer * slow.expected / slow.radius)) /
                          (fast.lateral - slow.lateral) * kStandardGravity;
  verification::verify("HMMWV turns at 2 to 8 m/s", "understeer gradient, rad per g", gradient, 0.0, 0.02,
                       "tires alike for their load", 1.0);
}
