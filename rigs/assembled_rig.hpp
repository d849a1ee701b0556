// The common part of drawbar rig, quarter car and half car: a test rig that is a multibody system of its own.
//
//   ground –prismatic (imposed speed)– trolley – … – carrier –revolute– rim, for each wheel
//
// Each kind of rig defines its bodies, joints, motors and force elements in build(), and its own measurements besides
// the report of every wheel. The accounts contain the energies of the system and of the chosen elements, and the works
// and impulses of rail, drive and tires. Works are mean force times displacement, step by step.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/constants.hpp"
#include "rigs/rig.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::rigs {

/// Inertia of bodies that do not turn, kg m²: it only scales the constraint matrix.
inline constexpr double kGuidedInertia = 20.0;

/// A wheel of an assembled rig. Turns are about the axle, forward positive.
struct AssembledWheel {
  double placed_height = 0.0;             // of the axle, at which the joints were defined, m
  int carrier = 0, rim = 0, spindle = 0;  // bodies, joint
  double carried_mass = 0.0;              // kg, including the tire's added mass
  WheelReport report;
  // During an advance and its steps
  Vec3 begin = Vec3::Zero();         // of the rim's centre, m
  RimState from;                     // of the rim
  double angle = 0.0;                // of the spindle, rad
  double turned = 0.0, turns = 0.0;  // in the last step; since the advance began, rad
};

class AssembledRig : public Rig {
 public:
  int wheel_count() const override { return static_cast<int>(wheels_.size()); }
  Vec3 heading(int) const override { return forward_; }

 protected:
  /// Start from rest: at `from`, s, over `ramp`, s, along +x or −x by the sign of `travel_sign`.
  struct Start {
    double from = 0.0, ramp = 0.0, travel_sign = 1.0;
  };
  AssembledRig(int wheels, const Start& start, const Vec3& gravity = standard_gravity());

  vehicle::MotionFunction from_rest(double speed) const;
  /// Speed at t = 0: 0 or `speed`.
  double at_first(double speed) const { return from_rest(speed)(0.0).rate; }
  const vehicle::BodyState& state(int body) const { return system_->body(body).state; }
  double mass(int body) const { return system_->body(body).mass; }

  // For use in build()
  int add_joint(vehicle::JointKind kind, const std::string& name, int a, int b, const Vec3& point, const Vec3& axis);
  /// Adds the rim with the tire's mass. @param inertia principal moments of the rim, kg m²
  void add_rim(AssembledWheel& wheel, const std::string& name, double mass, const Vec3& inertia,
               const vehicle::BodyState& state);
  /// Adds a damper c, N s/m, in a joint's free coordinate until a time, s. The accounts include its energy.
  int add_lowering_damper(const std::string& name, int joint, double c, double until);
  void keep_energy(int element);

  std::optional<vehicle::System> system_;
  std::vector<AssembledWheel> wheels_;
  Vec3 forward_;
  int trolley_ = 0, rail_ = 0, drive_ = 0;  // body, joint, motor: set by build()
  double total_mass_ = 0.0;                 // of all bodies, kg: set by build()
  RigAccounts accounts_ = RigAccounts::none();

 private:
  // Each kind of rig overrides these.
  /// Adds bodies, joints, motors and elements; sets the indices above, those of the wheels, and the masses.
  virtual void build() = 0;
  virtual void begin_rows() = 0;
  virtual void begin_advance() {}
  /// Adds to the sums of rows after a step, and to the works that only this rig has.
  virtual void add_step() {}
  virtual void end_advance(double /*duration*/, int /*substeps*/) {}
  /// Vertical momentum of all that wheel k carries, kg m/s. By default: of its carrier and rim.
  virtual double vertical_momentum(int k) const;
  virtual void measure_rows() {}
  virtual void save_rows(Archive& archive) const = 0;
  virtual void restore_rows(const Archive& archive) = 0;

  void do_place(std::span<const double> axle_height) final;
  RimState do_rim(int k) const final;
  Outcome do_advance(std::span<const Wrench> wrenches, double duration, int substeps) final;
  WheelReport do_report(int k) const final { return wheels_[k].report; }
  RigAccounts do_accounts() const final;
  void do_save(Archive& archive) const final;
  void do_restore(const Archive& archive) final;
  void make_system();
  void begin_step();
  void account(std::span<const Wrench> wrenches, double step);
  void measure_end();

  Start start_;
  Vec3 gravity_;
  vehicle::BodyState trolley_from_;  // at the beginning of the step
  std::vector<int> elements_;        // whose energies the accounts include
};

}  // namespace furrow::rigs
