// Interface energy errors. A force crosses one interval late, so the compared works are those of the *same* force on
// either side (the ground frame on both):
//   tire–terrain  e = Σ f̄ₙ·Δx_tire(n+1) − Σ_substeps f·Δx̃_terrain(n)
//                 with contact tangents, whose forces are those expected of the *same* interval, at n for both
//   rim–tire      e = (Fₙ·Δx + Mₙ·ωH)_rim(n+1) − (F·Δx + M·ωH)_tire(n),  F, M the complete spindle wrench
// The forces of a prompt tire cross within their interval: both works are those of n.
#include "nodes/output/series_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "rigs/reported_slip.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow::output {

namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Clears the values of each interval, so that a forgotten column becomes visible.
void forget_interval(WheelRow& row) {
  visit_fields(row, [](double& value, const Column& column) {
    if (column.kind == ColumnKind::mean || column.kind == ColumnKind::instant) value = kNotMeasured;
  });
}

}  // namespace

SeriesBuilder::SeriesBuilder(double radius, double ground, double step, bool level)
    : radius_(radius),
      ground_(ground),
      step_(step),
      level_(level),
      lines_(columns_of<WheelRow>()),
      values_(lines_.columns().size()) {}

void SeriesBuilder::add(const StepReports& r) {
  FURROW_ASSERT(std::abs(r.heading.norm() - 1.0) < 1e-9, r.heading.transpose());
  forget_interval(row_);
  measure_means(r);
  measure_tire_axes(r);
  measure_work(r);
  measure_instants(r);
  memory_.started = 1.0;
  get_values(row_, values_);
  lines_.add(values_);
}

void SeriesBuilder::measure_means(const StepReports& r) {
  row_.slip = r.wheel.slip;
  row_.slip_ratio = r.wheel.slip == 0.0 ? 0.0 : rigs::reported_slip_ratio(r.wheel.spin * radius_, r.wheel.speed);
  row_.speed = r.wheel.speed;
  row_.spin = r.wheel.spin;
  row_.force = r.contact.force;
  row_.vertical_force = r.contact.force.z();
  row_.normal_force_travel = r.contact.normal.dot(r.heading);
  row_.tractive_effort = r.contact.tangential.dot(r.heading);
  row_.spindle_force = r.tire.spindle.force;
  row_.spindle_moment = r.tire.spindle.moment;
  row_.drive_torque = r.wheel.drive_torque;
  row_.lateral_force = r.wheel.lateral_force;
  row_.aligning_moment = r.wheel.aligning_moment;
}

/// Uses the wrench that acted on the tire in this interval, whenever the terrain computed it, and the contact centre at
/// the interval's middle; thus the moments balance those on the rim. The ground plane is the undisturbed surface. If
/// the tire has sunk below it, or that is not level, the plane is at the tire's lowest point, the bottom of the rut.
void SeriesBuilder::measure_tire_axes(const StepReports& r) {
  RimState middle = r.rim;
  if (memory_.started > 0.0) middle.position = 0.5 * (memory_.last_rim_position + r.rim.position);
  const double lowest = r.tire.lowest_point;
  const tire::WheelAxes axes = tire::wheel_axes(middle, r.heading, level_ ? std::min(ground_, lowest) : lowest);
  const Wrench wrench = axes.wrench(r.tire.contact.force, r.tire.contact.moment, middle.position);
  row_.iso_force = wrench.force;
  row_.iso_moment = wrench.moment;
  row_.slip_angle = axes.slip_angle;
  row_.camber_angle = axes.camber_angle;
  row_.loaded_radius = axes.loaded_radius;
  memory_.rolled += r.wheel.speed * axes.x.dot(r.heading);
}

void SeriesBuilder::measure_work(const StepReports& r) {
  Memory& m = memory_;
  WheelRow& row = row_;
  const double tire_work = r.tire.terrain_work - m.last_tire_work;
  const bool same = r.tire.prompt || r.tire.contact_tangent;
  const double error = tire_work - (same ? r.contact.work : m.last_terrain_work);
  row.energy_error += error;
  row.energy_error_abs += std::abs(error);
  m.last_tire_work = r.tire.terrain_work;
  m.last_terrain_work = r.contact.work;

  const double rim_work = r.tire.rim_work - row.rim_work;
  if (m.started > 0.0) {
    const Vec3 turned = 0.5 * step_ * (m.last_angular_velocity + r.rim.angular_velocity);
    const Wrench& acted = r.tire.prompt ? r.tire.spindle : m.last_spindle;
    const double way = acted.force.dot(r.rim.position - m.last_rim_position), turn = acted.moment.dot(turned);
    row.rim_energy_error += way + turn + (r.tire.prompt ? rim_work : m.last_rim_work);
    row.passed_work += std::abs(way) + std::abs(turn);
  }
  m.last_rim_work = rim_work;
  row.rim_work = r.tire.rim_work;
  m.last_spindle = r.tire.spindle;
  m.last_rim_position = r.rim.position;
  m.last_angular_velocity = r.rim.angular_velocity;

  m.sent_arrived = m.sent;
  m.sent_abs_arrived = m.sent_abs;
  m.sent += step_ * r.contact.force;
  m.sent_abs += step_ * r.contact.force.norm();

  row.spindle_work += step_ * r.wheel.drive_torque * r.wheel.spin;
  row.transfer_force_residual = std::max(row.transfer_force_residual, r.contact.transfer_force_residual);
  row.transfer_moment_residual = std::max(row.transfer_moment_residual, r.contact.transfer_moment_residual);
}

void SeriesBuilder::measure_instants(const StepReports& r) {
  WheelRow& row = row_;
  row.time = r.time;
  row.position = r.wheel.axle_position;
  row.axle_height = r.wheel.axle_height;
  row.lowest_point = r.tire.lowest_point;
  row.sinkage = ground_ - r.tire.lowest_point;
  row.sinkage_kinematic = ground_ - r.wheel.axle_height + radius_;
  row.vertical_momentum = r.wheel.vertical_momentum;
  row.momentum_x_tire = r.tire.diagnostics.momentum.dot(r.heading);
  row.impulse_sent = memory_.sent;
  row.impulse_received = r.tire.impulse_received;
  row.soil_dissipation = r.terrain.energies.losses();
  row.tire_dissipation = r.tire.diagnostics.dissipation;
  row.terrain_kinetic_energy = r.terrain.kinetic_energy;
  row.terrain_potential_energy = r.terrain.energies.potential;
  row.terrain_elastic_energy = r.terrain.elastic_energy;
  row.tire_energy = r.tire.diagnostics.kinetic_energy + r.tire.diagnostics.strain_energy();
  // Vertical motion and height of the carried mass. Its imposed horizontal motion exchanges no net energy at constant
  // speed; while the speed changes, the raw pull's work includes this energy.
  const double mass = r.wheel.carried_mass, w = r.wheel.vertical_speed, u = r.wheel.speed;
  row.carried_energy = 0.5 * mass * (w * w + u * u) - (mass * r.wheel.gravity).dot(r.rim.position);
  row.contacts_tire = static_cast<double>(r.contact.contacts);
  row.contacts_terrain = static_cast<double>(r.terrain.contacts);
  row.active_share = r.grains > 0 ? static_cast<double>(r.terrain.active) / static_cast<double>(r.grains) : 1.0;
  row.newton_iterations = static_cast<double>(r.tire.newton_iterations);
  row.factorizations = static_cast<double>(r.tire.factorizations);
}

WheelRow SeriesBuilder::take() {
  const double share = lines_.share();
  WheelRow line;
  set_values(line, lines_.take());
  line.effective_rolling_radius = line.spin != 0.0 ? memory_.rolled * share / line.spin : 0.0;
  memory_.rolled = 0.0;
  return line;
}

WheelRow SeriesBuilder::now() const {
  WheelRow row;
  set_values(row, lines_.now());
  return row;
}

void SeriesBuilder::save(Archive& archive) const {
  lines_.save(archive, "series/");
  save_fields(archive, "interfaces", memory_);
}

void SeriesBuilder::restore(const Archive& archive) {
  lines_.restore(archive, "series/");
  row_ = now();
  restore_fields(archive, "interfaces", memory_);
}

}  // namespace furrow::output
