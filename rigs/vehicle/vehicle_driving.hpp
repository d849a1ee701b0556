// Conversions between a driver and a vehicle: the driver's view, and its inputs as the vehicle's. Drivers count gears
// from 1, with 0 for neutral and −1 for reverse; a gearbox counts them from 0.
#pragma once

#include <optional>

#include "vehicle/driver/driver.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// Inputs without a driver: the brakes hold.
inline vehicle::DriverInputs parked() { return {0.0, 1.0, 0.0, vehicle::gear_request::automatic}; }

vehicle::VehicleInputs vehicle_inputs(const vehicle::DriverInputs& inputs);

/// @param seat point of the vehicle's frame whose motion the driver sees, m
vehicle::DriverView driver_view(const vehicle::Vehicle& vehicle, const Vec3& seat);

/// Current or coming gear in the driver's count; without a gearbox, the position of the selector.
int gear_of(const vehicle::Vehicle& vehicle, const vehicle::DriverInputs& inputs);

/// Angle of the chassis's x axis about +z from the world's x axis, rad.
double yaw_of(const vehicle::Vehicle& vehicle);

}  // namespace furrow::rigs
