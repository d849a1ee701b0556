// Columns that the vehicle rig adds to those of every wheel, and the columns of the vehicle (subject `vehicle`).
#pragma once

#include "protocol/core/column.hpp"

namespace furrow::rigs {

/// Columns of wheel k, in the vehicle's frame: vehicle/analysis/wheel_angles.hpp.
struct VehicleWheelRow {
  double sinkage_in_rut = 0.0;  // bottom of the deepest rut before it − lowest tire point, m
  double travel = 0.0;          // of the wheel's centre from its drawn position, upward, m
  double camber = 0.0;          // positive: the top leans outward, rad
  double toe = 0.0;             // positive: toe-in, rad
  double steer = 0.0;           // positive: to the left, rad
  double spring_force = 0.0;    // pushes its ends apart, N
  double shock_force = 0.0;     // N
  double brake_torque = 0.0;    // on the wheel about its axle, N m; part of spindle_torque_Nm
};
void visit_fields(FieldsOf<VehicleWheelRow> auto& r, auto&& visit) {
  using namespace column;
  visit(r.sinkage_in_rut, instant("sinkage_in_rut_m", "m").following("sinkage_m"));
  visit(r.travel, instant("suspension_travel_m", "m"));
  visit(r.camber, instant("wheel_camber_rad", "rad"));
  visit(r.toe, instant("wheel_toe_rad", "rad"));
  visit(r.steer, instant("wheel_steer_rad", "rad"));
  visit(r.spring_force, mean("spring_force_N", "N"));
  visit(r.shock_force, mean("shock_force_N", "N"));
  visit(r.brake_torque, mean("brake_torque_Nm", "N m"));
}

/// Columns of the vehicle. Place and angles are those of its frame: x forward, y left, z up.
struct VehicleRow {
  double x = 0.0, y = 0.0, z = 0.0;           // of the vehicle's origin, m
  double roll = 0.0, pitch = 0.0, yaw = 0.0;  // of the chassis, rad; right side down, nose down, to the left
  double distance = 0.0;                      // of the origin over the ground, m
  double speed = 0.0;                         // of the origin over the ground, forward, m/s
  double lateral_speed = 0.0;                 // of the origin over the ground, to the left, m/s
  double acceleration = 0.0;                  // of the centre of mass of vehicle and tires, forward, m/s²
  double lateral_acceleration = 0.0;          // of this centre of mass, to the left, m/s²
  double yaw_rate = 0.0;                      // rad/s
  double throttle = 0.0, brake = 0.0;         // 0 to 1
  double steering = 0.0;                      // −1 to 1, positive to the left: the driver's input
  double gear = 0.0;                          // −1 reverse, 0 neutral, 1, 2, …
  double shifting = 0.0;                      // share of the time
  double engine_speed = 0.0;                  // of the crank, 1/min
  double turbine_speed = 0.0;                 // of the converter, 1/min
  double engine_torque = 0.0;                 // N m
  double engine_power = 0.0;                  // of engine and motors, W
  double wheel_power = 0.0;                   // of drive and brakes at the wheels, W
  double soil_power = 0.0;                    // dissipated in tires and ground, W
  double target_speed = 0.0, path_distance = 0.0, cross_track = 0.0, heading_error = 0.0;  // of the driver
  double drive_work = 0.0;                                                                 // of engine and motors, J
  double converter_heat = 0.0;                                                             // J
  double clutch_heat = 0.0;    // of clutch and locks of differentials, J
  double shift_heat = 0.0;     // J
  double brake_heat = 0.0;     // J
  double shock_heat = 0.0;     // J
  double lowering_heat = 0.0;  // of the damper that lowers the vehicle, J
  double spring_energy = 0.0;  // J
  double lock = 0.0;           // 1 while the driver locks the differentials that have a lock
};
void visit_fields(FieldsOf<VehicleRow> auto& r, auto&& visit) {
  using namespace column;
  visit(r.x, instant("x_m", "m"));
  visit(r.y, instant("y_m", "m"));
  visit(r.z, instant("z_m", "m"));
  visit(r.roll, instant("roll_rad", "rad"));
  visit(r.pitch, instant("pitch_rad", "rad"));
  visit(r.yaw, instant("yaw_rad", "rad"));
  visit(r.distance, cumulative("distance_m", "m"));
  visit(r.speed, mean("speed_m_s", "m/s"));
  visit(r.lateral_speed, mean("lateral_speed_m_per_s", "m/s"));
  visit(r.acceleration, mean("acceleration_m_per_s2", "m/s²"));
  visit(r.lateral_acceleration, mean("lateral_acceleration_m_per_s2", "m/s²"));
  visit(r.yaw_rate, mean("yaw_rate_rad_per_s", "rad/s"));
  visit(r.throttle, mean("throttle"));
  visit(r.brake, mean("brake"));
  visit(r.steering, mean("steering"));
  visit(r.gear, instant("gear"));
  visit(r.shifting, mean("shifting"));
  visit(r.engine_speed, mean("engine_speed_rpm", "1/min"));
  visit(r.turbine_speed, mean("turbine_speed_rpm", "1/min"));
  visit(r.engine_torque, mean("engine_torque_Nm", "N m"));
  visit(r.engine_power, mean("power_W", "W"));
  visit(r.wheel_power, mean("wheel_power_W", "W"));
  visit(r.soil_power, mean("soil_power_W", "W"));
  visit(r.target_speed, mean("target_speed_m_per_s", "m/s"));
  visit(r.path_distance, instant("path_distance_m", "m"));
  visit(r.cross_track, instant("cross_track_error_m", "m"));
  visit(r.heading_error, instant("heading_error_rad", "rad"));
  visit(r.drive_work, cumulative("drive_work_J", "J"));
  visit(r.converter_heat, cumulative("converter_heat_J", "J"));
  visit(r.clutch_heat, cumulative("clutch_heat_J", "J"));
  visit(r.shift_heat, cumulative("shift_heat_J", "J"));
  visit(r.brake_heat, cumulative("brake_heat_J", "J"));
  visit(r.shock_heat, cumulative("shock_heat_J", "J"));
  visit(r.lowering_heat, cumulative("lowering_heat_J", "J"));
  visit(r.spring_energy, instant("spring_energy_J", "J"));
  visit(r.lock, mean("lock"));
}

}  // namespace furrow::rigs
