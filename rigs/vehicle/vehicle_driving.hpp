// Between a driver and a vehicle: what the driver sees, and what its inputs are to the vehicle. Drivers count gears
// from 1, 0 is neutral and −1 reverse; a gearbox counts them from 0.
#pragma once

#include <optional>

#include "vehicle/driver/driver.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// What nobody does at the wheel: the brakes hold.
inline vehicle::DriverInputs parked() { return {0.0, 1.0, 0.0, vehicle::gear_request::automatic}; }

vehicle::VehicleInputs vehicle_inputs(const vehicle::DriverInputs& inputs);

/// @param seat point of the vehicle's frame whose motion the driver sees, m
vehicle::DriverView driver_view(const vehicle::Vehicle& vehicle, const Vec3& seat);

/// The gear that holds or will, as drivers count; of a vehicle without a gearbox as its selector stands.
int gear_of(const vehicle::Vehicle& vehicle, const vehicle::DriverInputs& inputs);

/// About +z, of the x axis of the chassis from that of the world, rad.
double yaw_of(const vehicle::Vehicle& vehicle);

}  // namespace furrow::rigs
