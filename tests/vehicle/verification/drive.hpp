// A vehicle on the simple ground: tires push along the ground as a function of their slip speed alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/vehicle/shipped.hpp"
#include "tests/vehicle/verification/simple_ground.hpp"

namespace furrow::testing {

struct DriveOptions {
  double grade = 0.0;
  double slip_width = 4.0;  // m/s: F = μ N tanh(v/width)
  double step = 2e-3;       // s
};

struct Drive {
  DriveOptions options;
  vehicle::Vehicle car;
  std::vector<GroundContact> contacts;

  explicit Drive(const char* file, const DriveOptions& how = {})
      : options(how), car(shipped(file), gravity_on_slope(how.grade)) {
    add_tires(car);
    contacts.assign(car.wheel_count(), {});
    put_on_ground(car, contacts.front());
  }
  void begin(double speed) { car.begin_rolling(speed, std::vector<double>(car.wheel_count(), contacts[0].radius), 0); }
  const vehicle::Body& chassis() const { return car.system().body(car.chassis()); }
  double speed() const { return chassis().state.velocity.dot(chassis().R * Vec3::UnitX()); }
  double roll() const { return std::atan2(chassis().R(2, 1), chassis().R(2, 2)); }
  double load(int k) const { return contacts[k].load(car.rim(k)); }
  /// Axle of wheel k in the vehicle's frame, to the left.
  Vec3 axle(int k) const {
    return chassis().R.transpose() * (car.rim(k).orientation.toRotationMatrix() * Vec3::UnitY());
  }
  /// Mean speed of all wheels in rolling without slip, m/s.
  double wheel_speed() const {
    double sum = 0.0;
    for (int k = 0; k < car.wheel_count(); ++k) {
      const RimState rim = car.rim(k);
      const Vec3 axis = rim.orientation.toRotationMatrix() * Vec3::UnitY();
      sum += (rim.angular_velocity - chassis().state.angular_velocity).dot(axis) * rim.position.z();
    }
    return sum / car.wheel_count();
  }
  /// Side force of the ground over the weight.
  double side() const {
    Vec3 force = Vec3::Zero();
    double weight = 0.0;
    const Mat3& R = chassis().R;
    for (int k = 0; k < car.wheel_count(); ++k) {
      const Vec3 one = contacts[k].roll(car.rim(k), options.slip_width).force;
      force += one, weight += one.z();
    }
    return std::abs(force.dot(Vec3(-R(1, 0), R(0, 0), 0.0))) / weight;
  }
  void step(const vehicle::VehicleInputs& inputs) {
    car.set_inputs(inputs);
    for (int k = 0; k < car.wheel_count(); ++k) car.set_wrench(k, contacts[k].roll(car.rim(k), options.slip_width));
    const Outcome outcome = car.step(options.step);
    if (!outcome.ok) throw physics_error(outcome, "HMMWV");
  }
  long steps(double duration) const { return std::lround(duration / options.step); }
};

inline vehicle::VehicleInputs full_throttle() {
  vehicle::VehicleInputs inputs;
  inputs.throttle = 1.0;
  return inputs;
}

}  // namespace furrow::testing
