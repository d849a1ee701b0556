// What the vehicle rig measures of each wheel: means over an advance from sums over its
// steps, and what holds at its end.
#pragma once

#include <vector>

#include "protocol/core/surface.hpp"
#include "rigs/rig.hpp"
#include "rigs/vehicle/vehicle_rows.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// What is saved of a wheel besides the vehicle's own state.
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

/// A row in speeds that turns a wheel, with what its torque does to the wheel.
struct TorqueRow {
  int row = 0;
  double factor = 1.0;
  bool brake = false;
};

/// What a wheel does in one advance: sums over the substeps.
struct WheelSums {
  double turned = 0.0, torque = 0.0, brake = 0.0, spring = 0.0, shock = 0.0;  // rad; N m, N times substeps
  Vec3 from = Vec3::Zero();                                                   // of its centre, m
};

/// Where wheel k travels: horizontal, unit, W.
Vec3 wheel_heading(const vehicle::Vehicle& car, int k);

/// Of each wheel. Rows in speeds act on a wheel's spindle as their second body, about the axle as it was when they were
/// added.
std::vector<std::vector<TorqueRow>> torque_rows(const vehicle::Vehicle& car);

/// After a step. @param before of the rim, before it @param rows of wheel k
void add_step(const vehicle::Vehicle& car, int k, const RimState& before, const std::vector<TorqueRow>& rows,
              WheelSums& sums);

/// After the last step of an advance. @param radius of the tire, undeformed, m @param wrench on the rim during it
/// @pre duration > 0, in s; substeps > 0
void measure_advance(const vehicle::Vehicle& car, int k, double radius, const Wrench& wrench, const WheelSums& sums,
                     double duration, int substeps, WheelRecord& wheel);

/// Of the instant. @param heading of the vehicle's x axis at t = 0, about +z from the world's, rad
void measure_now(const vehicle::Vehicle& car, int k, double heading, WheelRecord& wheel);

}  // namespace furrow::rigs
