// Measurements of each wheel by the vehicle rig: means over an advance, from sums over its steps, and values at its
// end.
#pragma once

#include <vector>

#include "protocol/core/surface.hpp"
#include "rigs/rig.hpp"
#include "rigs/vehicle/vehicle_rows.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// Saved values of a wheel besides the vehicle's own state.
struct WheelRecord {
  WheelReport report;
  VehicleWheelRow row;
  double load = 0.0;  // at rest, N
};
void visit_fields(FieldsOf<WheelRecord> auto& s, auto&& visit) {
  visit(s.report, Field{"report", ""});
  visit(s.row, Field{"row", ""});
  visit(s.load, Field{"load", "N"});
}

/// A row in speeds whose torque turns a wheel.
struct TorqueRow {
  int row = 0;
  double factor = 1.0;
  bool brake = false;
};

/// Sums of a wheel over the substeps of one advance.
struct WheelSums {
  double turned = 0.0, torque = 0.0, brake = 0.0, spring = 0.0, shock = 0.0;  // rad; N m, N times substeps
  Vec3 from = Vec3::Zero();                                                   // of its centre, m
};

/// Direction in which wheel k travels: horizontal, unit, W.
Vec3 wheel_heading(const vehicle::Vehicle& car, int k);

/// Rows in speeds of each wheel. They act on a wheel's spindle as their second body, about the axle at the time when
/// they were added.
std::vector<std::vector<TorqueRow>> torque_rows(const vehicle::Vehicle& car);

/// Adds a step to the sums. @param before the rim's state before the step @param rows of wheel k
void add_step(const vehicle::Vehicle& car, int k, const RimState& before, const std::vector<TorqueRow>& rows,
              WheelSums& sums);

/// Sets the means after the last step of an advance.
/// @param radius of the tire, undeformed, m @param wrench on the rim during the advance
/// @pre duration > 0, in s; substeps > 0
void measure_advance(const vehicle::Vehicle& car, int k, double radius, const Wrench& wrench, const WheelSums& sums,
                     double duration, int substeps, WheelRecord& wheel);

/// Measures current values. @param heading of the vehicle's x axis at t = 0, about +z from the world's, rad
void measure_now(const vehicle::Vehicle& car, int k, double heading, WheelRecord& wheel);

}  // namespace furrow::rigs
