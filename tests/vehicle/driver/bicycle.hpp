// A kinematic bicycle: wheels that roll without side slip. It moves on exact circles between two calls of its driver.
#pragma once

#include <cmath>

#include "vehicle/driver/driver.hpp"

namespace furrow::testing {

inline vehicle::DriverCar test_car() {
  vehicle::DriverCar car;
  car.wheelbase = 3.3;
  car.steering_lock = 0.6;
  car.width = 2.0;
  car.mass = 2400.0;
  car.drive_force = 10e3;
  car.brake_force = 20e3;
  return car;
}

struct Bicycle {
  double x = 0.0, y = 0.0, yaw = 0.0, speed = 0.0;  // of the middle of the rear axle

  vehicle::DriverView view(double time) const {
    vehicle::DriverView view;
    view.time = time;
    view.position = Vec3(x, y, 0.0);
    view.velocity = speed * Vec3(std::cos(yaw), std::sin(yaw), 0.0);
    view.yaw = yaw;
    return view;
  }
  /// Moves for a time dt along a circle of this curvature.
  void roll(double curvature, double dt) {
    const double half = 0.5 * curvature * speed * dt;
    const double chord = speed * dt * (std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
    x += chord * std::cos(yaw + half);
    y += chord * std::sin(yaw + half);
    yaw += 2.0 * half;
  }
};

/// tan δ/L
inline double curvature_of(const vehicle::DriverInputs& inputs, const vehicle::DriverCar& car) {
  return std::tan(inputs.steering * car.steering_lock) / car.wheelbase;
}

/// Calls the driver and moves, `steps` times; calls each(time, driver, bicycle) after every call of the driver.
/// @param response actual curvature as a function of the commanded one
template <class Each>
void follow(vehicle::Driver& driver, Bicycle& bicycle, int steps, double dt, const Each& each, double response = 1.0) {
  for (int i = 0; i < steps; ++i) {
    const double time = i * dt;
    const vehicle::DriverInputs inputs = driver.drive(bicycle.view(time));
    each(time);
    bicycle.roll(response * curvature_of(inputs, test_car()), dt);
  }
}

}  // namespace furrow::testing
