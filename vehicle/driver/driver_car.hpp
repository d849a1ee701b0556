// The properties that a driver is given, from the vehicle's own data.
//
//   wheelbase      from the middle of the rear axle to the middle of the steered axle, or without one of the foremost
//   steering lock  mean angle of the steered wheels at steering 1. A vehicle that steers by the speeds of its sides
//                  turns at full command with the curvature 2 s/b, s its skid_steer and b its track, if its wheels do
//                  not slip sideways; its lock is that of a car with the same curvature, atan(2 s L/b)
//   drive force    largest torque of the engine times the converter's ratio at stall through the lowest gear, or all
//                  motors at stall; at most kGrip × weight
//   brake force    all brakes, or the motors if there are no brakes; at most kGrip × weight
#pragma once

#include <span>

#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

/// Index of the rearmost axle.
int rear_axle(const VehicleSpec& spec);
/// Middle of the rear axle as drawn, in the vehicle's frame, m. Drivers get the position of this point.
Vec3 rear_axle_middle(const VehicleSpec& spec);
/// Whether the steering wheel has an effect.
bool can_steer(const VehicleSpec& spec);
/// Whether a driver can follow a path: an axle ahead of the last one steers, or the wheels of one side turn faster.
bool can_follow(const VehicleSpec& spec);
/// Whether an engine or motor drives a wheel.
bool can_drive(const VehicleSpec& spec);
/// Whether a wheel has a brake.
bool can_brake(const VehicleSpec& spec);
/// Whether a differential has a lock.
bool can_lock(const VehicleSpec& spec);

/// @param radii of the tires, m, one for each wheel @param tire_width the widest tire's, m @param mass with tires, kg
/// @post every member is positive. @throws Error(physics) naming a suspension that cannot be steered
DriverCar driver_car(const VehicleSpec& spec, std::span<const double> radii, double tire_width, double mass);

}  // namespace furrow::vehicle
