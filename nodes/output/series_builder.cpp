// Interface energy errors: a force crosses one interval late, so that the works compared are those of the *same*
// force on either side (the ground frame on both):
//   tire–terrain  e = Σ f̄ₙ·Δx_tire(n+1) − Σ_substeps f·Δx̃_terrain(n)
//                 with contact tangents, whose forces are those expected of the *same* interval, at n for both
//   rim–tire      e = (Fₙ·Δx + Mₙ·ωH)_rim(n+1) − (F·Δx + M·ωH)_tire(n),  F, M the complete spindle wrench
#include "nodes/output/series_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow::output {

namespace {

/// Visits the fields that are means over the intervals of a line.
template <class Visit>
void for_each_mean(SeriesRow& row, Visit visit) {
  for (double* mean :
       {&row.slip, &row.speed, &row.spin, &row.drawbar_pull, &row.drawbar_pull_raw, &row.normal_force_travel,
        &row.tractive_effort, &row.drive_torque, &row.lateral_force, &row.aligning_moment, &row.damper_force,
        &row.slip_angle, &row.camber_angle, &row.loaded_radius, &row.effective_rolling_radius})
    visit(*mean);
  for (Vec3* mean : {&row.force, &row.spindle_force, &row.spindle_moment, &row.iso_force, &row.iso_moment})
    for (int i = 0; i < 3; ++i) visit((*mean)[i]);
}

}  // namespace

void SeriesBuilder::add(const StepReports& r) {
  FURROW_ASSERT(std::abs(r.travel.norm() - 1.0) < 1e-9, r.travel.transpose());
  FURROW_ASSERT(memory_.started == 0.0 || r.time > memory_.row.time, r.time, memory_.row.time);
  add_means(r);
  add_tire_axes(r);
  add_work(r);
  set_instants(r);
  memory_.started = 1.0;
}

void SeriesBuilder::add_means(const StepReports& r) {
  SeriesRow& row = memory_.row;
  memory_.count += 1.0;
  row.slip += r.wheel.slip;
  row.speed += r.wheel.speed;
  row.spin += r.wheel.spin;
  row.drawbar_pull += r.wheel.drawbar_pull;
  row.drawbar_pull_raw += r.wheel.drawbar_pull_raw;
  row.force += r.contact.force;
  row.normal_force_travel += r.contact.normal.dot(r.travel);
  row.tractive_effort += r.contact.tangential.dot(r.travel);
  row.spindle_force += r.tire.spindle.force;
  row.spindle_moment += r.tire.spindle.moment;
  row.drive_torque += r.wheel.drive_torque;
  row.lateral_force += r.wheel.lateral_force;
  row.aligning_moment += r.wheel.aligning_moment;
  row.damper_force += r.wheel.damper_force;
}

/// Contact sums are means over the interval, so the contact centre is that of its middle. The ground plane is the
/// undisturbed surface, or where the tire has sunk below it the tire's lowest point: the bottom of the rut.
void SeriesBuilder::add_tire_axes(const StepReports& r) {
  SeriesRow& row = memory_.row;
  RimState middle = r.rim;
  if (memory_.started > 0.0) middle.position = 0.5 * (memory_.last_rim_position + r.rim.position);
  const tire::WheelAxes axes = tire::wheel_axes(middle, r.travel, std::min(ground_, r.tire.lowest_point));
  const Wrench wrench = axes.wrench(r.contact.force, r.contact.moment, Vec3::Zero());
  row.iso_force += wrench.force;
  row.iso_moment += wrench.moment;
  row.slip_angle += axes.slip_angle;
  row.camber_angle += axes.camber_angle;
  row.loaded_radius += axes.loaded_radius;
  row.effective_rolling_radius += r.wheel.speed * axes.x.dot(r.travel);  // divided by the spin in take()
  memory_.load = r.wheel.carried_mass * kStandardGravity;
}

void SeriesBuilder::add_work(const StepReports& r) {
  Memory& m = memory_;
  SeriesRow& row = m.row;
  const double tire_work = r.tire.terrain_work - m.last_tire_work;
  const double error = tire_work - (r.tire.contact_tangent ? r.contact.work : m.last_terrain_work);
  row.energy_error += error;
  row.energy_error_abs += std::abs(error);
  m.last_tire_work = r.tire.terrain_work;
  m.last_terrain_work = r.contact.work;

  if (m.started > 0.0) {
    const Vec3 turned = 0.5 * step_ * (m.last_angular_velocity + r.rim.angular_velocity);
    const double rim_side =
        m.last_spindle.force.dot(r.rim.position - m.last_rim_position) + m.last_spindle.moment.dot(turned);
    row.rim_energy_error += rim_side + m.last_rim_work;
  }
  m.last_rim_work = r.tire.rim_work - row.rim_work;
  row.rim_work = r.tire.rim_work;
  m.last_spindle = r.tire.spindle;
  m.last_rim_position = r.rim.position;
  m.last_angular_velocity = r.rim.angular_velocity;

  m.sent_arrived = m.sent;
  m.sent_abs_arrived = m.sent_abs;
  m.sent += step_ * r.contact.force;
  m.sent_abs += step_ * r.contact.force.norm();

  row.spindle_work += step_ * r.wheel.drive_torque * r.wheel.spin;
  row.pull_work += step_ * r.wheel.drawbar_pull_raw * r.wheel.speed;
  row.transfer_force_residual = std::max(row.transfer_force_residual, r.contact.transfer_force_residual);
  row.transfer_moment_residual = std::max(row.transfer_moment_residual, r.contact.transfer_moment_residual);
  row.damper_dissipation += step_ * std::abs(r.wheel.damper_force * r.wheel.vertical_speed);
}

void SeriesBuilder::set_instants(const StepReports& r) {
  SeriesRow& row = memory_.row;
  row.time = r.time;
  row.position = r.wheel.axle_position;
  row.axle_height = r.wheel.axle_height;
  row.lowest_point = r.tire.lowest_point;
  row.sinkage = ground_ - r.tire.lowest_point;
  row.sinkage_kinematic = ground_ - r.wheel.axle_height + radius_;
  row.vertical_momentum = r.wheel.vertical_momentum;
  row.momentum_x_tire = r.tire.momentum.dot(r.travel);
  row.impulse_sent = memory_.sent;
  row.impulse_received = r.tire.impulse_received;
  row.soil_dissipation = r.terrain.dissipation;
  row.tire_dissipation = r.tire.dissipation;
  row.terrain_kinetic_energy = r.terrain.kinetic_energy;
  row.terrain_potential_energy = r.terrain.potential_energy;
  row.terrain_elastic_energy = r.terrain.elastic_energy;
  row.tire_energy = r.tire.kinetic_energy + r.tire.strain_energy;
  // Vertical motion and height of the carried mass; its imposed horizontal motion exchanges no net energy at
  // constant speed and is in the raw pull's work while it changes.
  const double mass = r.wheel.carried_mass, w = r.wheel.vertical_speed, u = r.wheel.speed;
  row.carried_energy = 0.5 * mass * (w * w + u * u) + mass * kStandardGravity * r.wheel.axle_height;
  row.contacts_tire = static_cast<double>(r.contact.contacts);
  row.contacts_terrain = static_cast<double>(r.terrain.contacts);
  row.active_share =
      r.grains > 0 ? static_cast<double>(r.terrain.active) / static_cast<double>(r.grains) : 1.0;
  row.newton_iterations = static_cast<double>(r.tire.newton_iterations);
  row.factorizations = static_cast<double>(r.tire.factorizations);
}

SeriesRow SeriesBuilder::take() {
  SeriesRow line = memory_.row;
  const double share = memory_.count > 0.0 ? 1.0 / memory_.count : 0.0;
  for_each_mean(line, [share](double& mean) { mean *= share; });
  const auto ratio = [](double a, double b) { return b != 0.0 ? a / b : 0.0; };
  line.effective_rolling_radius = ratio(line.effective_rolling_radius, line.spin);
  line.tractive_efficiency = ratio(line.drawbar_pull * line.speed, line.drive_torque * line.spin);
  line.motion_resistance = ratio(line.drive_torque / radius_ - line.drawbar_pull, memory_.load);
  for_each_mean(memory_.row, [](double& sum) { sum = 0.0; });
  memory_.count = 0.0;
  return line;
}

void SeriesBuilder::save(Archive& archive) const {
  std::vector<double> values(sizeof(Memory) / sizeof(double));
  std::memcpy(values.data(), static_cast<const void*>(&memory_), sizeof(Memory));
  archive.put("series", values);
}

void SeriesBuilder::restore(const Archive& archive) {
  const auto& values = archive.get<double>("series", sizeof(Memory) / sizeof(double));
  std::memcpy(static_cast<void*>(&memory_), values.data(), sizeof(Memory));
}

}  // namespace furrow::output
