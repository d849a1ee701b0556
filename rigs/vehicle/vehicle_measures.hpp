// Columns of the vehicle's own table, measured on the vehicle and its driver.
#pragma once

#include "rigs/vehicle/vehicle_rows.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

struct MotionBefore {
  Vec3 origin = Vec3::Zero();    // of the vehicle, m
  Vec3 momentum = Vec3::Zero();  // kg m/s
  double drive_work = 0.0;       // J

  static MotionBefore of(const vehicle::Vehicle& car);
};

/// Sums of the driveline over steps; finish_driveline() makes means over the advance of them.
void begin_driveline(VehicleRow& row);
void add_driveline(const vehicle::Vehicle& car, VehicleRow& row);
/// @pre substeps > 0; duration > 0, in s
void finish_driveline(const vehicle::Vehicle& car, const MotionBefore& before, double duration, int substeps,
                      VehicleRow& row);

/// Measures the mean motion over the advance. @pre duration > 0, in s; `row` has the yaw at the beginning
void measure_motion(const vehicle::Vehicle& car, const MotionBefore& before, double duration, VehicleRow& row);

/// @param driver null: there is no driver
void measure_driver(const vehicle::DriverInputs& inputs, const vehicle::Driver* driver, VehicleRow& row);

void measure_now(const vehicle::Vehicle& car, const vehicle::DriverInputs& inputs, VehicleRow& row);

}  // namespace furrow::rigs
