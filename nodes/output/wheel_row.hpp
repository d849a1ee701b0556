// What the table of results says of every wheel, whatever the rig: one list of columns beside the struct. A column is
// added by a member, its line in the list, and a value for it in SeriesBuilder.
#pragma once

#include "protocol/core/column.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::output {

struct WheelRow {
  double time = 0.0;                      // s
  double slip = 0.0;                      // -
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
  Vec3 impulse_sent = Vec3::Zero();       // terrain's own account of what it gave the tire, N s
  Vec3 impulse_received = Vec3::Zero();   // N s
  double energy_error = 0.0;              // Σe at the tire–terrain interface, J
  double energy_error_abs = 0.0;          // Σ|e|, J
  double rim_energy_error = 0.0;          // Σe at the rim–tire interface, J
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
};

/// The columns in the order of the files; those that users script against come first and keep their place.
void visit_fields(auto&& visit, FieldsOf<WheelRow> auto& r) {
  using namespace column;
  visit(instant("time_s", "s"), r.time);
  visit(mean("slip"), r.slip);
  visit(instant("sinkage_m", "m"), r.sinkage);
  visit(mean("vertical_force_N", "N"), r.vertical_force);
  visit(mean("force_x_N", "N"), r.force.x());
  visit(mean("force_y_N", "N"), r.force.y());
  visit(mean("force_z_N", "N"), r.force.z());
  visit(mean("spindle_torque_Nm", "N m"), r.drive_torque);
  visit(cumulative("impulse_sent_Ns", "N s"), r.impulse_sent.z());
  visit(cumulative("impulse_received_Ns", "N s"), r.impulse_received.z());
  visit(cumulative("energy_error_J", "J"), r.energy_error);
  visit(mean("speed_m_per_s", "m/s"), r.speed);
  visit(mean("spin_rad_per_s", "rad/s"), r.spin);
  visit(instant("position_m", "m"), r.position);
  visit(instant("axle_height_m", "m"), r.axle_height);
  visit(instant("lowest_point_m", "m"), r.lowest_point);
  visit(instant("sinkage_kinematic_m", "m"), r.sinkage_kinematic);
  visit(mean("tractive_effort_N", "N"), r.tractive_effort);
  visit(mean("terrain_resistance_N", "N").negative(), r.normal_force_travel);
  visit(mean("lateral_force_N", "N"), r.lateral_force);
  visit(mean("aligning_moment_Nm", "N m"), r.aligning_moment);
  visit(mean("spindle_force_x_N", "N"), r.spindle_force.x());
  visit(mean("spindle_force_y_N", "N"), r.spindle_force.y());
  visit(mean("spindle_force_z_N", "N"), r.spindle_force.z());
  visit(mean("spindle_moment_x_Nm", "N m"), r.spindle_moment.x());
  visit(mean("spindle_moment_y_Nm", "N m"), r.spindle_moment.y());
  visit(mean("spindle_moment_z_Nm", "N m"), r.spindle_moment.z());
  visit(instant("vertical_momentum_kg_m_per_s", "kg m/s"), r.vertical_momentum);
  visit(instant("tire_momentum_travel_kg_m_per_s", "kg m/s"), r.momentum_x_tire);
  visit(cumulative("impulse_sent_x_Ns", "N s"), r.impulse_sent.x());
  visit(cumulative("impulse_sent_y_Ns", "N s"), r.impulse_sent.y());
  visit(cumulative("impulse_received_x_Ns", "N s"), r.impulse_received.x());
  visit(cumulative("impulse_received_y_Ns", "N s"), r.impulse_received.y());
  visit(cumulative("energy_error_abs_J", "J"), r.energy_error_abs);
  visit(cumulative("rim_energy_error_J", "J"), r.rim_energy_error);
  visit(cumulative("rim_work_J", "J"), r.rim_work);
  visit(cumulative("spindle_work_J", "J"), r.spindle_work);
  visit(cumulative("soil_dissipation_J", "J"), r.soil_dissipation);
  visit(cumulative("tire_dissipation_J", "J"), r.tire_dissipation);
  visit(instant("terrain_kinetic_energy_J", "J"), r.terrain_kinetic_energy);
  visit(instant("terrain_potential_energy_J", "J"), r.terrain_potential_energy);
  visit(instant("terrain_elastic_energy_J", "J"), r.terrain_elastic_energy);
  visit(instant("tire_energy_J", "J"), r.tire_energy);
  visit(instant("carried_energy_J", "J"), r.carried_energy);
  visit(instant("contacts_tire"), r.contacts_tire);
  visit(instant("contacts_terrain"), r.contacts_terrain);
  visit(instant("active_share"), r.active_share);
  visit(cumulative("newton_iterations"), r.newton_iterations);
  visit(cumulative("factorizations"), r.factorizations);
  visit(largest("transfer_force_residual"), r.transfer_force_residual);
  visit(largest("transfer_moment_residual"), r.transfer_moment_residual);
  visit(mean("iso_force_x_N", "N"), r.iso_force.x());
  visit(mean("iso_force_y_N", "N"), r.iso_force.y());
  visit(mean("iso_force_z_N", "N"), r.iso_force.z());
  visit(mean("iso_moment_x_Nm", "N m"), r.iso_moment.x());
  visit(mean("iso_moment_y_Nm", "N m"), r.iso_moment.y());
  visit(mean("iso_moment_z_Nm", "N m"), r.iso_moment.z());
  visit(mean("slip_angle_rad", "rad"), r.slip_angle);
  visit(mean("camber_angle_rad", "rad"), r.camber_angle);
  visit(mean("loaded_radius_m", "m"), r.loaded_radius);
  visit(derived("effective_rolling_radius_m", "m"), r.effective_rolling_radius);
}

}  // namespace furrow::output
