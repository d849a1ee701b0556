// The common part of quarter car and half car: a car for ride as a multibody system. Its trolley rides on a rail, and
// only the drive acts on it. Each wheel has a suspension, and a damper lowers what the wheels carry.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "rigs/assembled_rig.hpp"
#include "rigs/ride_row.hpp"

namespace furrow::rigs {

struct Suspension {
  double body_share = 0.0;                // part of the body's mass that it carries at rest, kg
  double stiffness = 0.0, damping = 0.0;  // N/m, N s/m
  int element = 0;                        // index in the system
  double rose = 0.0;                      // speed of the body above the wheel when the advance began, upwards, m/s
  RideRow row = {};
};

/// `Options` is the struct of the car's keys.
template <class Options>
class RideCar : public AssembledRig {
 public:
  std::vector<Subject> subjects() const override {
    std::vector<Subject> all = plain_wheels(wheel_count());
    for (Subject& wheel : all) wheel.columns = columns_of<RideRow>();
    return all;
  }
  void measure(int k, std::span<double> values) const override { get_values(suspensions_.at(k).row, values); }

 protected:
  RideCar(const Options& o, std::vector<Suspension> suspensions)
      : AssembledRig(static_cast<int>(suspensions.size()), {o.move_from, o.ramp}),
        options_(o),
        suspensions_(std::move(suspensions)) {
    FURROW_ASSERT(o.body_mass > 0.0 && o.unsprung_mass > 0.0 && o.rim_mass > 0.0 && o.lowering_speed > 0.0, o.body_mass,
                  o.unsprung_mass, o.rim_mass, o.lowering_speed);
    for (const Suspension& s : suspensions_)
      FURROW_ASSERT(s.body_share > 0.0 && s.stiffness >= 0.0 && s.damping >= 0.0, s.body_share, s.stiffness, s.damping);
  }

  // For build(); bodies and joints must be added in this order.
  // Adds the trolley. @returns its state, with which other bodies begin
  vehicle::BodyState add_trolley(const Vec3& position) {
    constexpr double kTrolleyMass = 1.0;  // kg
    const vehicle::BodyState state{.position = position, .velocity = at_first(options_.speed) * forward_};
    trolley_ = system_->add_body("trolley", kTrolleyMass, guided(), state);
    total_mass_ = kTrolleyMass;
    for (int k = 0; k < wheel_count(); ++k) {
      const double wheel = options_.rim_mass + tire(k).mass.mass;
      wheels_[k].carried_mass = suspensions_[k].body_share + options_.unsprung_mass + wheel;
      total_mass_ += wheels_[k].carried_mass;
    }
    return state;
  }
  void add_rail() {
    rail_ = add_joint(vehicle::JointKind::prismatic, "rail", vehicle::kGround, trolley_, state(trolley_).position,
                      forward_);
  }
  void add_drive() { drive_ = system_->add_motor("trolley drive", rail_, from_rest(options_.speed)); }
  /// Adds carrier and rim. @param state of the wheel's centre
  void add_wheel(int k, const std::string& name, vehicle::BodyState state) {
    AssembledWheel& w = wheels_[k];
    w.carrier = system_->add_body(name + "carrier", options_.unsprung_mass, guided(), state);
    state.angular_velocity = state.velocity.x() / tire(k).radius * Vec3::UnitY();
    add_rim(w, name + "rim", options_.rim_mass,
            Vec3(options_.rim_diametral_inertia, options_.rim_spin_inertia, options_.rim_diametral_inertia), state);
  }
  void add_spindle(int k, const std::string& name) {
    AssembledWheel& w = wheels_[k];
    w.spindle = add_joint(vehicle::JointKind::revolute, name + "spindle", w.carrier, w.rim, state(w.rim).position,
                          Vec3::UnitY());
  }
  void add_lowering(int guide) {
    double mass = 0.0;
    for (const AssembledWheel& w : wheels_) mass += w.carried_mass;
    add_lowering_damper("lowering damper", guide, mass * kStandardGravity / options_.lowering_speed,
                        options_.touchdown_time);
  }
  static Mat3 guided() { return kGuidedInertia * Mat3::Identity(); }

  Options options_;
  std::vector<Suspension> suspensions_;  // of each wheel

 private:
  /// Vertical speed of the body above a wheel, m/s.
  virtual double rise(int k) const = 0;
  /// Upward force of a suspension on the body, and force that keeps its wheel at its speed: means of the last step, N.
  virtual double strut_force(int k) const = 0;
  virtual double held_force(int k) const = 0;

 protected:
  void begin_rows() override {
    for (Suspension& s : suspensions_) {
      s.row = {};
      s.row.force = s.body_share * kStandardGravity;
    }
  }
  void begin_advance() override {
    for (int k = 0; k < wheel_count(); ++k) {
      suspensions_[k].rose = rise(k);
      suspensions_[k].row.force = suspensions_[k].row.drive_force = 0.0;
    }
  }
  void add_step() override {
    for (int k = 0; k < wheel_count(); ++k) {
      suspensions_[k].row.force += strut_force(k);
      suspensions_[k].row.drive_force += held_force(k);
    }
  }
  void end_advance(double duration, int substeps) override {
    for (int k = 0; k < wheel_count(); ++k) {
      RideRow& row = suspensions_[k].row;
      row.force /= substeps;
      row.drive_force /= substeps;
      row.body_acceleration = (rise(k) - suspensions_[k].rose) / duration;
    }
  }
  void save_rows(Archive& archive) const override {
    for (std::size_t k = 0; k < suspensions_.size(); ++k)
      save_fields(archive, "ride" + std::to_string(k), suspensions_[k].row);
  }
  void restore_rows(const Archive& archive) override {
    for (std::size_t k = 0; k < suspensions_.size(); ++k)
      restore_fields(archive, "ride" + std::to_string(k), suspensions_[k].row);
  }

 private:
  double vertical_momentum(int k) const override {
    const AssembledWheel& w = wheels_[k];
    return suspensions_[k].body_share * rise(k) + mass(w.carrier) * state(w.carrier).velocity.z() +
           mass(w.rim) * state(w.rim).velocity.z();
  }
};

}  // namespace furrow::rigs
