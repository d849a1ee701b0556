#include "vehicle/parts/vehicle.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

/// The axle whose arms carry this one's wheels, or −1.
int host_of(const VehicleSpec& spec, const AxleSpec& axle) {
  const auto* fixed = std::get_if<FixedSpec>(&axle.corners[kLeft].suspension);
  return fixed != nullptr && fixed->on ? spec.axle(*fixed->on) : -1;
}

}  // namespace

Vehicle::Vehicle(const VehicleSpec& spec, const Vec3& gravity) : spec_(spec), system_(gravity) {
  chassis_ = add_body(system_, "chassis", spec_.chassis);
  add_axles();
  for (const Wheel& wheel : wheels_) {
    brakes_.emplace_back();
    if (wheel.corner->brake)
      brakes_.back() =
          FrictionCoupling::brake(system_, wheel.name + " brake", wheel.carrier, wheel.spindle,
                                  system_.body(wheel.spindle).R * Vec3::UnitY(), wheel.corner->brake->torque);
  }
  drive_ = std::make_unique<DriveTrain>(system_, spec_, chassis_, wheels_);
  system_.assemble(0.0);
  if (system_.redundant_count() > 0)
    throw physics_error("vehicle '" + spec_.name + "': joint '" + system_.redundant_names().front() +
                        "' holds what others hold already, expected joints that leave the wheels their travel");
}

// Axles whose wheels are on the arms of other axles come after those.
void Vehicle::add_axles() {
  wheels_.resize(2 * spec_.axles.size());
  steerings_.resize(spec_.axles.size());
  for (const bool hosted : {false, true})
    for (std::size_t k = 0; k < spec_.axles.size(); ++k) {
      const AxleSpec& axle = spec_.axles[k];
      const int host = host_of(spec_, axle);
      if ((host >= 0) != hosted) continue;
      int rods = chassis_;
      if (axle.steering) {
        steerings_[k].emplace(system_, axle.name, *axle.steering, chassis_);
        rods = steerings_[k]->rods();
      }
      std::array<Wheel, 2> carriers;
      if (host >= 0) carriers = {wheels_[2 * host], wheels_[2 * host + 1]};
      const auto wheels = add_axle(system_, axle, static_cast<int>(k), chassis_, rods, host >= 0 ? &carriers : nullptr);
      wheels_[2 * k] = wheels[kLeft];
      wheels_[2 * k + 1] = wheels[kRight];
    }
}

double Vehicle::mass() const {
  double sum = 0.0;
  for (int i = 0; i < system_.body_count(); ++i) sum += system_.body(i).mass;
  return sum;
}

Vec3 Vehicle::origin() const {
  const Body& chassis = system_.body(chassis_);
  return chassis.state.position - chassis.R * spec_.chassis.center_of_mass;
}

int Vehicle::freedoms() const {
  int held = system_.constraint_count();
  for (int i = 0; i < system_.rate_row_count(); ++i)
    if (const RateControl& control = system_.rate_control(i);
        control.mode == RateMode::hold && std::isinf(control.lower) && std::isinf(control.upper))
      ++held;
  return 6 * system_.body_count() + system_.shaft_count() - held + system_.redundant_count();
}

void Vehicle::add_tire_mass(int wheel, const MassProperties& tire) {
  FURROW_ASSERT(in_range(wheel, wheels_.size()), wheel, wheels_.size());
  const Body& spindle = system_.body(wheels_[wheel].spindle);
  system_.set_mass_properties(wheels_[wheel].spindle, spindle.mass + tire.mass, spindle.inertia + tire.inertia);
}

RimState Vehicle::rim(int wheel) const {
  FURROW_ASSERT(in_range(wheel, wheels_.size()), wheel, wheels_.size());
  const BodyState& state = system_.body(wheels_[wheel].spindle).state;
  return {state.position, state.orientation, state.velocity, state.angular_velocity};
}

void Vehicle::set_wrench(int wheel, const Wrench& wrench) {
  FURROW_ASSERT(in_range(wheel, wheels_.size()), wheel, wheels_.size());
  system_.set_load(wheels_[wheel].spindle, wrench.force, wrench.moment);
}

void Vehicle::set_inputs(const VehicleInputs& inputs) {
  FURROW_ASSERT(inputs.brake >= 0.0 && inputs.brake <= 1.0, inputs.brake);
  for (const std::optional<FrictionCoupling>& brake : brakes_)
    if (brake) brake->engage(system_, inputs.brake);
  for (std::optional<Steering>& steering : steerings_)
    if (steering) steering->set_target(system_.time(), inputs.steering);
  drive_->set_inputs(system_, inputs);
}

void Vehicle::move(const Vec3& by) {
  for (int i = 0; i < system_.body_count(); ++i) {
    BodyState state = system_.body(i).state;
    state.position += by;
    system_.set_state(i, state);
  }
  system_.assemble(system_.time());
}

void Vehicle::turn(const Quat& turn, const Vec3& about) {
  FURROW_ASSERT(std::abs(turn.norm() - 1.0) < 1e-9, turn.norm());
  for (int i = 0; i < system_.body_count(); ++i) {
    BodyState state = system_.body(i).state;
    state.position = about + turn * (state.position - about);
    state.orientation = (turn * state.orientation).normalized();
    state.velocity = turn * state.velocity;
    state.angular_velocity = turn * state.angular_velocity;
    system_.set_state(i, state);
  }
  system_.assemble(system_.time());
}

void Vehicle::begin_rolling(double speed, std::span<const double> radii, int gear) {
  FURROW_ASSERT(radii.size() == wheels_.size() && std::isfinite(speed), radii.size(), speed);
  Vec3 forward = system_.body(chassis_).R.col(0);
  forward.z() = 0.0;
  std::vector<double> spins;
  for (int i = 0; i < system_.body_count(); ++i) {
    BodyState state = system_.body(i).state;
    state.velocity = speed * forward.normalized();
    system_.set_state(i, state);
  }
  for (std::size_t k = 0; k < wheels_.size(); ++k) {
    spins.push_back(speed / radii[k]);
    BodyState state = system_.body(wheels_[k].spindle).state;
    state.angular_velocity = spins.back() * system_.body(wheels_[k].spindle).R.col(1);
    system_.set_state(wheels_[k].spindle, state);
  }
  drive_->begin_rolling(system_, spins, gear);
  system_.assemble(system_.time());
}

Outcome Vehicle::step(double h) {
  if (Outcome drive = drive_->advance(system_, h); !drive.ok) return drive;
  return system_.step(h);
}

void Vehicle::save(Archive& archive) const {
  system_.save(archive);
  drive_->save(archive);
  for (std::size_t k = 0; k < steerings_.size(); ++k) {
    if (!steerings_[k]) continue;
    Archive::Scope scope(archive, "axle" + std::to_string(k) + "/");
    steerings_[k]->save(archive);
  }
}

void Vehicle::restore(const Archive& archive) {
  drive_->restore(archive);
  for (std::size_t k = 0; k < steerings_.size(); ++k) {
    if (!steerings_[k]) continue;
    Archive::Scope scope(archive, "axle" + std::to_string(k) + "/");
    steerings_[k]->restore(archive);
  }
  system_.restore(archive);
}

}  // namespace furrow::vehicle
