// What the vehicle rig measures beside the columns of every wheel: of each wheel, and of
// the vehicle (subject `vehicle`).
#pragma once

#include "protocol/core/column.hpp"

namespace furrow::rigs {

/// Of wheel k, in the vehicle's frame: vehicle/analysis/wheel_angles.hpp.
struct VehicleWheelRow {
  double sinkage_in_rut = 0.0;  // bottom of the deepest rut before it − lowest tire point, m
  double travel = 0.0;          // of the wheel's centre against its drawn position, upward, m
  double camber = 0.0;          // positive: the top leans outward, rad
  double toe = 0.0;             // positive: toe-in, rad
  double steer = 0.0;           // positive: to the left, rad
  double spring_force = 0.0;    // pushes its ends apart, N
  double shock_force = 0.0;     // N
  double brake_torque = 0.0;    // on the wheel about its axle, N m; part of spindle_torque_Nm
};
void visit_fields(auto&& visit, FieldsOf<VehicleWheelRow> auto& r) {
  using namespace column;
  visit(instant("sinkage_in_rut_m", "m").following("sinkage_m"), r.sinkage_in_rut);
  visit(instant("suspension_travel_m", "m"), r.travel);
  visit(instant("wheel_camber_rad", "rad"), r.camber);
  visit(instant("wheel_toe_rad", "rad"), r.toe);
  visit(instant("wheel_steer_rad", "rad"), r.steer);
  visit(mean("spring_force_N", "N"), r.spring_force);
  visit(mean("shock_force_N", "N"), r.shock_force);
  visit(mean("brake_torque_Nm", "N m"), r.brake_torque);
}

/// Of the vehicle. Place and angles are those of its frame: x forward, y left, z up.
struct VehicleRow {
  double x = 0.0, y = 0.0, z = 0.0;           // of the vehicle's origin, m
  double roll = 0.0, pitch = 0.0, yaw = 0.0;  // of the chassis, rad; right side down, nose down, to the left
  double distance = 0.0;                      // that the origin has moved over the ground, m
  double speed = 0.0;                         // of the origin over the ground, forward, m/s
  double lateral_speed = 0.0;                 // likewise, to the left, m/s
  double acceleration = 0.0;                  // of the centre of mass of all, forward, m/s²
  double lateral_acceleration = 0.0;          // likewise, to the left, m/s²
  double yaw_rate = 0.0;                      // rad/s
  double throttle = 0.0, brake = 0.0;         // 0 to 1
  double steering = 0.0;                      // −1 to 1, positive to the left: what the driver turns
  double gear = 0.0;                          // −1 reverse, 0 neutral, 1, 2, …
  double shifting = 0.0;                      // share of the time
  double engine_speed = 0.0;                  // of the crank, 1/min
  double turbine_speed = 0.0;                 // of the converter, 1/min
  double engine_torque = 0.0;                 // N m
  double engine_power = 0.0;                  // of engine and motors, W
  double wheel_power = 0.0;                   // of drive and brakes at the wheels, W
  double soil_power = 0.0;                    // that tires and ground take, W
  double target_speed = 0.0, path_distance = 0.0, cross_track = 0.0, heading_error = 0.0;  // of the driver
  double drive_work = 0.0;                                                                 // of engine and motors, J
  double converter_heat = 0.0;                                                             // J
  double clutch_heat = 0.0;    // of clutch and locks of differentials, J
  double shift_heat = 0.0;     // J
  double brake_heat = 0.0;     // J
  double shock_heat = 0.0;     // J
  double lowering_heat = 0.0;  // of the damper that lets the vehicle down, J
  double spring_energy = 0.0;  // J
};
void visit_fields(auto&& visit, FieldsOf<VehicleRow> auto& r) {
  using namespace column;
  visit(instant("x_m", "m"), r.x);
  visit(instant("y_m", "m"), r.y);
  visit(instant("z_m", "m"), r.z);
  visit(instant("roll_rad", "rad"), r.roll);
  visit(instant("pitch_rad", "rad"), r.pitch);
  visit(instant("yaw_rad", "rad"), r.yaw);
  visit(cumulative("distance_m", "m"), r.distance);
  visit(mean("speed_m_s", "m/s"), r.speed);
  visit(mean("lateral_speed_m_per_s", "m/s"), r.lateral_speed);
  visit(mean("acceleration_m_per_s2", "m/s²"), r.acceleration);
  visit(mean("lateral_acceleration_m_per_s2", "m/s²"), r.lateral_acceleration);
  visit(mean("yaw_rate_rad_per_s", "rad/s"), r.yaw_rate);
  visit(mean("throttle"), r.throttle);
  visit(mean("brake"), r.brake);
  visit(mean("steering"), r.steering);
  visit(instant("gear"), r.gear);
  visit(mean("shifting"), r.shifting);
  visit(mean("engine_speed_rpm", "1/min"), r.engine_speed);
  visit(mean("turbine_speed_rpm", "1/min"), r.turbine_speed);
  visit(mean("engine_torque_Nm", "N m"), r.engine_torque);
  visit(mean("power_W", "W"), r.engine_power);
  visit(mean("wheel_power_W", "W"), r.wheel_power);
  visit(mean("soil_power_W", "W"), r.soil_power);
  visit(mean("target_speed_m_per_s", "m/s"), r.target_speed);
  visit(instant("path_distance_m", "m"), r.path_distance);
  visit(instant("cross_track_error_m", "m"), r.cross_track);
  visit(instant("heading_error_rad", "rad"), r.heading_error);
  visit(cumulative("drive_work_J", "J"), r.drive_work);
  visit(cumulative("converter_heat_J", "J"), r.converter_heat);
  visit(cumulative("clutch_heat_J", "J"), r.clutch_heat);
  visit(cumulative("shift_heat_J", "J"), r.shift_heat);
  visit(cumulative("brake_heat_J", "J"), r.brake_heat);
  visit(cumulative("shock_heat_J", "J"), r.shock_heat);
  visit(cumulative("lowering_heat_J", "J"), r.lowering_heat);
  visit(instant("spring_energy_J", "J"), r.spring_energy);
}

}  // namespace furrow::rigs
