#include "rigs/vehicle/wheel_measures.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "rigs/reported_slip.hpp"
#include "vehicle/analysis/held_vehicle.hpp"
#include "vehicle/analysis/wheel_angles.hpp"

namespace furrow::rigs {
namespace {

constexpr double kStandsFroude = 0.01;  // v/√(g r) below which a wheel stands

}  // namespace

Vec3 wheel_heading(const vehicle::Vehicle& car, int k) {
  const Vec3 axle = vehicle::spin_axis(car, k);
  return Vec3(axle.y(), -axle.x(), 0.0).normalized();
}

std::vector<std::vector<TorqueRow>> torque_rows(const vehicle::Vehicle& car) {
  std::vector<std::vector<TorqueRow>> rows(car.wheel_count());
  const vehicle::System& system = car.system();
  for (int k = 0; k < car.wheel_count(); ++k)
    for (int i = 0; i < system.rate_row_count(); ++i)
      for (const vehicle::SpinTerm& term : system.rate_row(i).spins)
        if (term.b == car.wheel(k).spindle) {
          const bool brake = car.brake(k) && car.brake(k)->row() == i;
          rows[k].push_back({i, term.factor * term.axis.y(), brake});
        }
  return rows;
}

void add_step(const vehicle::Vehicle& car, int k, const RimState& before, const std::vector<TorqueRow>& rows,
              WheelSums& sums) {
  const vehicle::System& system = car.system();
  const vehicle::Wheel& wheel = car.wheel(k);
  const Eigen::AngleAxisd turn(car.rim(k).orientation * before.orientation.conjugate());
  sums.turned += turn.angle() * turn.axis().dot(vehicle::spin_axis(car, k));
  for (const TorqueRow& one : rows) {
    const double torque = one.factor * system.rate_state(one.row).torque;
    sums.torque += torque;
    if (one.brake) sums.brake += torque;
  }
  if (wheel.spring) sums.spring += system.element_force(*wheel.spring);
  if (wheel.shock) sums.shock += system.element_force(*wheel.shock);
}

void measure_advance(const vehicle::Vehicle& car, int k, double radius, const Wrench& wrench, const WheelSums& sums,
                     double duration, int substeps, WheelRecord& wheel) {
  FURROW_ASSERT(duration > 0.0 && substeps > 0 && radius > 0.0, duration, substeps, radius);
  WheelReport& report = wheel.report;
  const Vec3 forward = wheel_heading(car, k), left = Vec3::UnitZ().cross(forward);
  report.speed = forward.dot(car.rim(k).position - sums.from) / duration;
  report.spin = sums.turned / duration;
  const double rolled = report.spin * radius,
               stands = kStandsFroude * std::sqrt(car.system().gravity().norm() * radius);
  const bool at_rest = std::abs(rolled) < stands && std::abs(report.speed) < stands;
  report.slip = at_rest ? 0.0 : reported_slip(rolled, report.speed);
  report.drive_torque = sums.torque / substeps;
  report.lateral_force = wrench.force.dot(left);
  report.aligning_moment = wrench.moment.z();
  wheel.row.brake_torque = sums.brake / substeps;
  wheel.row.spring_force = sums.spring / substeps;
  wheel.row.shock_force = sums.shock / substeps;
}

void measure_now(const vehicle::Vehicle& car, int k, double heading, WheelRecord& record) {
  const vehicle::System& system = car.system();
  const vehicle::Body& chassis = system.body(car.chassis());
  const vehicle::Wheel& wheel = car.wheel(k);
  const vehicle::Body& spindle = system.body(wheel.spindle);
  WheelReport& report = record.report;
  VehicleWheelRow& row = record.row;
  const double outward = vehicle::outward(wheel.side);
  report.axle_height = spindle.state.position.z();
  report.axle_position = Vec3(std::cos(heading), std::sin(heading), 0.0).dot(spindle.state.position);
  report.vertical_speed = system.body(wheel.carrier).state.velocity.z();
  report.carried_mass = -record.load / system.gravity().z();
  report.vertical_momentum =
      spindle.mass * spindle.state.velocity.z() + (report.carried_mass - spindle.mass) * chassis.state.velocity.z();
  report.joint_drift = system.max_violation();
  report.gravity = system.gravity();
  const Vec3 axle = chassis.R.transpose() * vehicle::spin_axis(car, k),
             center = chassis.R.transpose() * (spindle.state.position - car.origin());
  row.travel = center.z() - vehicle::spindle_of(wheel.corner->suspension).center.z();
  row.camber = vehicle::camber_angle(axle, outward);
  row.toe = vehicle::toe_angle(axle, outward);
  row.steer = vehicle::steer_angle(axle);
}

}  // namespace furrow::rigs
