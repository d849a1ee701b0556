// One line of the time series: means over the communication intervals since the last line for forces and torques,
// instants for positions, sums since the start for what is called cumulative.
#pragma once

#include <cstdint>

#include "protocol/core/vec.hpp"

namespace furrow::output {

struct SeriesRow {
  double time = 0.0;                      // s
  double slip = 0.0;                      // -
  double speed = 0.0;                     // carriage, along travel, m/s
  double spin = 0.0;                      // rad/s
  double position = 0.0;                  // axle, along travel, m
  double drawbar_pull = 0.0;              // inertia-corrected, N
  double drawbar_pull_raw = 0.0;          // N
  double sinkage = 0.0;                   // undisturbed height − lowest tire point, m
  double sinkage_kinematic = 0.0;         // h₀ − z_axle + R, m
  double axle_height = 0.0;               // z, m
  double lowest_point = 0.0;              // z, m
  Vec3 force = Vec3::Zero();              // on the tire by the terrain, W, N
  double normal_force_travel = 0.0;       // Σ F_normal·e, N (terrain resistance is its negative)
  double tractive_effort = 0.0;           // Σ F_tangential·e, N
  Vec3 spindle_force = Vec3::Zero();      // on the rim by the tire, W, N
  Vec3 spindle_moment = Vec3::Zero();     // about the rim centre, W, N m
  double drive_torque = 0.0;              // N m
  double lateral_force = 0.0;             // N
  double aligning_moment = 0.0;           // N m
  double vertical_momentum = 0.0;         // carried mass, kg m/s
  double damper_force = 0.0;              // N
  double momentum_x_tire = 0.0;           // tire's own momentum along travel, kg m/s
  Vec3 impulse_sent = Vec3::Zero();       // cumulative, terrain's own account of what it gave the tire, N s
  Vec3 impulse_received = Vec3::Zero();   // cumulative, N s
  double energy_error = 0.0;              // cumulative Σe at the tire–terrain interface, J
  double energy_error_abs = 0.0;          // cumulative Σ|e|, J
  double rim_energy_error = 0.0;          // cumulative Σe at the rim–tire interface, J
  double rim_work = 0.0;                  // cumulative work of the rim on the tire, J
  double spindle_work = 0.0;              // cumulative ∫ T ω dt, J
  double pull_work = 0.0;                 // cumulative ∫ pull v dt, J
  double soil_dissipation = 0.0;          // cumulative, J
  double tire_dissipation = 0.0;          // cumulative, J
  double terrain_kinetic_energy = 0.0;    // J
  double terrain_potential_energy = 0.0;  // J
  double terrain_elastic_energy = 0.0;    // J
  double tire_energy = 0.0;               // kinetic + strain, J
  double carried_energy = 0.0;            // kinetic + gravity of carrier and rim, J
  double damper_dissipation = 0.0;        // cumulative, touch-down damper, J
  double contacts_tire = 0.0;             // number of tire–terrain contacts
  double contacts_terrain = 0.0;          // number of contacts in the terrain
  double active_share = 1.0;              // grains awake / grains
  double newton_iterations = 0.0;         // cumulative
  double factorizations = 0.0;            // cumulative
  double transfer_force_residual = 0.0;   // largest since the start
  double transfer_moment_residual = 0.0;  // largest since the start
  // In the tire's axes on the ground (wheel_axes.hpp); means over the line
  Vec3 iso_force = Vec3::Zero();   // on the tire by the terrain, N
  Vec3 iso_moment = Vec3::Zero();  // about the contact centre, N m
  double slip_angle = 0.0;         // rad
  double camber_angle = 0.0;       // rad
  double loaded_radius = 0.0;      // m
  double effective_rolling_radius =
      0.0;                           // forward speed of the wheel centre in the wheel's heading / spin, m
  double tractive_efficiency = 0.0;  // pull power / spindle power; 0 where the spindle gives none
  double motion_resistance = 0.0;    // (torque / undeformed radius − pull) / load
};

}  // namespace furrow::output
