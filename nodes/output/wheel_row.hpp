// Columns of every wheel's table for any rig: a struct and one list of columns. To add a column, add a member, its line
// in the list, and its value in SeriesBuilder.
#pragma once

#include "protocol/core/column.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::output {

struct WheelRow {
  double time = 0.0;                      // s
  double slip = 0.0;                      // 1 − v/(ω R), -
  double speed = 0.0;                     // carriage, along the heading, m/s
  double spin = 0.0;                      // rad/s
  double position = 0.0;                  // axle, along the heading, m
  double sinkage = 0.0;                   // undisturbed height − lowest tire point, m
  double sinkage_kinematic = 0.0;         // h₀ − z_axle + R, m
  double axle_height = 0.0;               // z, m
  double lowest_point = 0.0;              // z, m
  double vertical_force = 0.0;            // on the tire by the terrain, z, N
  Vec3 force = Vec3::Zero();              // on the tire by the terrain, W, N
  double normal_force_travel = 0.0;       // Σ F_normal·e, N (terrain resistance is its negative)
  double tractive_effort = 0.0;           // Σ F_tangential·e, N
  Vec3 spindle_force = Vec3::Zero();      // on the rim by the tire, W, N
  Vec3 spindle_moment = Vec3::Zero();     // about the rim centre, W, N m
  double drive_torque = 0.0;              // N m
  double lateral_force = 0.0;             // N
  double aligning_moment = 0.0;           // N m
  double vertical_momentum = 0.0;         // carried mass, kg m/s
  double momentum_x_tire = 0.0;           // tire's own momentum along the heading, kg m/s
  Vec3 impulse_sent = Vec3::Zero();       // what the terrain gave the tire by the terrain's own account, N s
  Vec3 impulse_received = Vec3::Zero();   // N s
  double energy_error = 0.0;              // Σe at the tire–terrain interface, J
  double energy_error_abs = 0.0;          // Σ|e|, J
  double rim_energy_error = 0.0;          // Σe at the rim–tire interface, J
  double passed_work = 0.0;               // Σ(|F·Δx| + |M·Δθ|) of the rim by the tire, J
  double rim_work = 0.0;                  // work of the rim on the tire, J
  double spindle_work = 0.0;              // ∫ T ω dt, J
  double soil_dissipation = 0.0;          // J
  double tire_dissipation = 0.0;          // J
  double terrain_kinetic_energy = 0.0;    // J
  double terrain_potential_energy = 0.0;  // J
  double terrain_elastic_energy = 0.0;    // J
  double tire_energy = 0.0;               // kinetic + strain, J
  double carried_energy = 0.0;            // kinetic + gravity of carrier and rim, J
  double contacts_tire = 0.0;             // number of tire–terrain contacts
  double contacts_terrain = 0.0;          // number of contacts in the terrain
  double active_share = 1.0;              // grains awake / grains
  double newton_iterations = 0.0;         // -
  double factorizations = 0.0;            // -
  double transfer_force_residual = 0.0;   // -
  double transfer_moment_residual = 0.0;  // -
  // In the tire's axes on the ground (wheel_axes.hpp)
  Vec3 iso_force = Vec3::Zero();   // on the tire by the terrain, N
  Vec3 iso_moment = Vec3::Zero();  // about the contact centre, N m
  double slip_angle = 0.0;         // rad
  double camber_angle = 0.0;       // rad
  double loaded_radius = 0.0;      // m
  // Mean forward speed of the wheel centre in the wheel's plane over the mean spin, m
  double effective_rolling_radius = 0.0;
  double slip_ratio = 0.0;  // (ω R − v)/v after ISO 8855, −1 for a locked wheel, R as in slip, -
};

/// The columns in the order of the files. Columns on which users' scripts rely come first and keep their place.
void visit_fields(FieldsOf<WheelRow> auto& r, auto&& visit) {
  using namespace column;
  visit(r.time, instant("time_s", "s"));
  visit(r.slip, mean("slip"));
  visit(r.sinkage, instant("sinkage_m", "m"));
  visit(r.vertical_force, mean("vertical_force_N", "N"));
  visit(r.force.x(), mean("force_x_N", "N"));
  visit(r.force.y(), mean("force_y_N", "N"));
  visit(r.force.z(), mean("force_z_N", "N"));
  visit(r.drive_torque, mean("spindle_torque_Nm", "N m"));
  visit(r.impulse_sent.z(), cumulative("impulse_sent_Ns", "N s"));
  visit(r.impulse_received.z(), cumulative("impulse_received_Ns", "N s"));
  visit(r.energy_error, cumulative("energy_error_J", "J"));
  visit(r.speed, mean("speed_m_per_s", "m/s"));
  visit(r.spin, mean("spin_rad_per_s", "rad/s"));
  visit(r.position, instant("position_m", "m"));
  visit(r.axle_height, instant("axle_height_m", "m"));
  visit(r.lowest_point, instant("lowest_point_m", "m"));
  visit(r.sinkage_kinematic, instant("sinkage_kinematic_m", "m"));
  visit(r.tractive_effort, mean("tractive_effort_N", "N"));
  visit(r.normal_force_travel, mean("terrain_resistance_N", "N").negative());
  visit(r.lateral_force, mean("lateral_force_N", "N"));
  visit(r.aligning_moment, mean("aligning_moment_Nm", "N m"));
  visit(r.spindle_force.x(), mean("spindle_force_x_N", "N"));
  visit(r.spindle_force.y(), mean("spindle_force_y_N", "N"));
  visit(r.spindle_force.z(), mean("spindle_force_z_N", "N"));
  visit(r.spindle_moment.x(), mean("spindle_moment_x_Nm", "N m"));
  visit(r.spindle_moment.y(), mean("spindle_moment_y_Nm", "N m"));
  visit(r.spindle_moment.z(), mean("spindle_moment_z_Nm", "N m"));
  visit(r.vertical_momentum, instant("vertical_momentum_kg_m_per_s", "kg m/s"));
  visit(r.momentum_x_tire, instant("tire_momentum_travel_kg_m_per_s", "kg m/s"));
  visit(r.impulse_sent.x(), cumulative("impulse_sent_x_Ns", "N s"));
  visit(r.impulse_sent.y(), cumulative("impulse_sent_y_Ns", "N s"));
  visit(r.impulse_received.x(), cumulative("impulse_received_x_Ns", "N s"));
  visit(r.impulse_received.y(), cumulative("impulse_received_y_Ns", "N s"));
  visit(r.energy_error_abs, cumulative("energy_error_abs_J", "J"));
  visit(r.rim_energy_error, cumulative("rim_energy_error_J", "J"));
  visit(r.passed_work, cumulative("passed_work_J", "J"));
  visit(r.rim_work, cumulative("rim_work_J", "J"));
  visit(r.spindle_work, cumulative("spindle_work_J", "J"));
  visit(r.soil_dissipation, cumulative("soil_dissipation_J", "J"));
  visit(r.tire_dissipation, cumulative("tire_dissipation_J", "J"));
  visit(r.terrain_kinetic_energy, instant("terrain_kinetic_energy_J", "J"));
  visit(r.terrain_potential_energy, instant("terrain_potential_energy_J", "J"));
  visit(r.terrain_elastic_energy, instant("terrain_elastic_energy_J", "J"));
  visit(r.tire_energy, instant("tire_energy_J", "J"));
  visit(r.carried_energy, instant("carried_energy_J", "J"));
  visit(r.contacts_tire, instant("contacts_tire"));
  visit(r.contacts_terrain, instant("contacts_terrain"));
  visit(r.active_share, instant("active_share"));
  visit(r.newton_iterations, cumulative("newton_iterations"));
  visit(r.factorizations, cumulative("factorizations"));
  visit(r.transfer_force_residual, largest("transfer_force_residual"));
  visit(r.transfer_moment_residual, largest("transfer_moment_residual"));
  visit(r.iso_force.x(), mean("iso_force_x_N", "N"));
  visit(r.iso_force.y(), mean("iso_force_y_N", "N"));
  visit(r.iso_force.z(), mean("iso_force_z_N", "N"));
  visit(r.iso_moment.x(), mean("iso_moment_x_Nm", "N m"));
  visit(r.iso_moment.y(), mean("iso_moment_y_Nm", "N m"));
  visit(r.iso_moment.z(), mean("iso_moment_z_Nm", "N m"));
  visit(r.slip_angle, mean("slip_angle_rad", "rad"));
  visit(r.camber_angle, mean("camber_angle_rad", "rad"));
  visit(r.loaded_radius, mean("loaded_radius_m", "m"));
  visit(r.effective_rolling_radius, derived("effective_rolling_radius_m", "m"));
  visit(r.slip_ratio, mean("slip_ratio"));
}

}  // namespace furrow::output
