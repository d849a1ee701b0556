#include "rigs/assembled_rig.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/saved_number.hpp"
#include "rigs/reported_slip.hpp"

namespace furrow::rigs {

AssembledRig::AssembledRig(int wheels, const Start& start, const Vec3& gravity)
    : wheels_(wheels), forward_(start.travel_sign, 0.0, 0.0), start_(start), gravity_(gravity) {
  FURROW_ASSERT(wheels > 0 && start.from >= 0.0 && start.ramp >= 0.0, wheels, start.from, start.ramp);
}

vehicle::MotionFunction AssembledRig::from_rest(double speed) const {
  FURROW_ASSERT(std::isfinite(speed), speed);
  return [speed, start = start_](double t) { return vehicle::ramped_motion(t - start.from, speed, start.ramp); };
}

int AssembledRig::add_joint(vehicle::JointKind kind, const std::string& name, int a, int b, const Vec3& point,
                            const Vec3& axis) {
  return system_->add_joint(kind, name, a, b, {.point = point, .axis = axis});
}

void AssembledRig::add_rim(AssembledWheel& wheel, const std::string& name, double mass, const Vec3& inertia,
                           const vehicle::BodyState& state) {
  const MassProperties& added = tire(static_cast<int>(&wheel - wheels_.data())).mass;
  wheel.rim = system_->add_body(name, mass + added.mass, Mat3(inertia.asDiagonal()) + added.inertia, state);
}

int AssembledRig::add_lowering_damper(const std::string& name, int joint, double c, double until) {
  const int damper = system_->add_joint_element(name, joint, [c, until](double, double rate, double t) {
    return t < until ? vehicle::ElementForce{-c * rate, c} : vehicle::ElementForce{};
  });
  system_->track_energy(damper);
  elements_.insert(elements_.begin(), damper);
  return damper;
}

void AssembledRig::keep_energy(int element) {
  system_->track_energy(element);
  elements_.push_back(element);
}

void AssembledRig::make_system() {
  system_.emplace(gravity_);
  elements_.clear();
  build();
  FURROW_ASSERT(total_mass_ > 0.0, total_mass_);
}

void AssembledRig::do_place(std::span<const double> axle_height) {
  for (std::size_t k = 0; k < wheels_.size(); ++k) wheels_[k].placed_height = axle_height[k];
  make_system();
  system_->assemble(0.0);
  accounts_ = RigAccounts::none();
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    WheelReport& report = wheels_[k].report;
    report = {};
    report.speed = forward_.dot(state(wheels_[k].rim).velocity);
    report.spin = report.speed / tire(static_cast<int>(k)).radius;
  }
  begin_rows();
  measure_end();
}

RimState AssembledRig::do_rim(int k) const {
  const vehicle::BodyState& rim = state(wheels_[k].rim);
  return {rim.position, rim.orientation, rim.velocity, rim.angular_velocity};
}

Outcome AssembledRig::do_advance(std::span<const Wrench> wrenches, double duration, int substeps) {
  begin_advance();
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    AssembledWheel& w = wheels_[k];
    system_->set_load(w.rim, wrenches[k].force, wrenches[k].moment);
    w.begin = state(w.rim).position;
    w.turns = 0.0;
  }
  const double step = duration / substeps;
  for (int i = 0; i < substeps; ++i) {
    begin_step();
    if (Outcome outcome = system_->step(step); !outcome.ok) return outcome;
    account(wrenches, step);
    add_step();
  }
  const bool stands = system_->time() <= start_.from;
  const Vec3 left = Vec3::UnitZ().cross(forward_);
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    AssembledWheel& w = wheels_[k];
    w.report.speed = (forward_.dot(state(w.rim).position) - forward_.dot(w.begin)) / duration;
    w.report.spin = w.turns / duration;
    w.report.lateral_force = wrenches[k].force.dot(left);
    w.report.aligning_moment = wrenches[k].moment.z();
    const double rolled = w.report.spin * tire(static_cast<int>(k)).radius;
    w.report.slip = stands ? 0.0 : reported_slip(rolled, w.report.speed);
  }
  end_advance(duration, substeps);
  measure_end();
  return {};
}

void AssembledRig::begin_step() {
  trolley_from_ = state(trolley_);
  for (int k = 0; k < wheel_count(); ++k) {
    wheels_[k].from = do_rim(k);
    wheels_[k].angle = system_->coordinate(wheels_[k].spindle).value;
  }
}

/// A joint's reaction acts on body B, in the axes of the joint's frame on A. For the rail, A is the ground.
void AssembledRig::account(std::span<const Wrench> wrenches, double step) {
  const Mat3& axes = system_->joint(rail_).frame_a.axes;
  const vehicle::Reaction& reaction = system_->reaction(rail_);
  const vehicle::BodyState& trolley = state(trolley_);
  const Vec3 rail = axes * reaction.force, drive = system_->motor_force(drive_) * forward_;
  const Vec3 way = trolley.position - trolley_from_.position;
  accounts_.tow_work += drive.dot(way);
  accounts_.guide_work +=
      rail.dot(way) + (axes * reaction.moment).dot(mean_turn(trolley_from_.orientation, trolley.orientation));
  accounts_.gravity_impulse += step * total_mass_ * gravity_;
  accounts_.guide_impulse += step * (rail + drive);
  for (int k = 0; k < wheel_count(); ++k) {
    AssembledWheel& w = wheels_[k];
    const double turned = std::remainder(system_->coordinate(w.spindle).value - w.angle, 2.0 * std::numbers::pi);
    w.turned = start_.travel_sign * turned;
    w.turns += w.turned;
    add_tire(accounts_, w.from, do_rim(k), wrenches[k], step);
  }
}

RigAccounts AssembledRig::do_accounts() const {
  RigAccounts now = accounts_;
  now.kinetic_energy = system_->kinetic_energy();
  now.potential_energy = system_->gravity_energy();
  for (const int element : elements_) {
    const vehicle::ElementEnergy energy = system_->element_energy(element);
    now.potential_energy += energy.stored;
    now.damper_loss += energy.dissipated;
  }
  now.momentum = system_->momentum();
  return now;
}

double AssembledRig::vertical_momentum(int k) const {
  const AssembledWheel& w = wheels_[k];
  return mass(w.carrier) * state(w.carrier).velocity.z() + mass(w.rim) * state(w.rim).velocity.z();
}

void AssembledRig::measure_end() {
  for (int k = 0; k < wheel_count(); ++k) {
    AssembledWheel& w = wheels_[k];
    const Vec3& axle = state(w.rim).position;
    w.report.axle_height = axle.z();
    w.report.axle_position = forward_.dot(axle);
    w.report.vertical_speed = state(w.carrier).velocity.z();
    w.report.carried_mass = w.carried_mass;
    w.report.vertical_momentum = vertical_momentum(k);
    w.report.joint_drift = system_->max_violation();
    w.report.gravity = gravity_;
  }
  measure_rows();
}

void AssembledRig::do_save(Archive& archive) const {
  system_->save(archive);
  save_fields(archive, "accounts", accounts_);
  save_rows(archive);
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    const Archive::Scope scope(archive, "wheel" + std::to_string(k) + "/");
    save_fields(archive, "report", wheels_[k].report);
    archive.put("placed_height", wheels_[k].placed_height);
  }
}

void AssembledRig::do_restore(const Archive& archive) {
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    const Archive::Scope scope(archive, "wheel" + std::to_string(k) + "/");
    restore_fields(archive, "report", wheels_[k].report);
    wheels_[k].placed_height = saved_finite(archive, "placed_height");
  }
  make_system();
  restore_rows(archive);
  system_->restore(archive);
  restore_fields(archive, "accounts", accounts_);
  measure_end();
}

}  // namespace furrow::rigs
