// A rig carries the tires: a test rig or a vehicle, as a multibody assembly.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/column.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/core/surface.hpp"
#include "rigs/rig_accounts.hpp"

namespace furrow::rigs {

/// Measurements of wheel k. Forces, torques, speed, spin and slip are means over the last advance; positions, vertical
/// speed, momentum and drift are values at its end. Frame of the heading: e forward, l = z × e (left when looking along
/// e), z up. The wheels of a vehicle share what they carry: the carried mass of each follows from its load at rest.
struct WheelReport {
  double slip = 0.0;               // 1 − v/(ω r), r the undeformed radius; at most ±1e6, 0 at rest
  double speed = 0.0;              // of the wheel's carrier along the heading, m/s
  double spin = 0.0;               // of the rim about its axle, rad/s, forward positive
  double drive_torque = 0.0;       // of the spindle motor about the axle, N m, positive if it drives forward
  double lateral_force = 0.0;      // on the rim by the tire, along l, N
  double aligning_moment = 0.0;    // on the rim by the tire, about z, N m
  double axle_height = 0.0;        // z of the rim centre, m
  double axle_position = 0.0;      // along the heading; for a vehicle along its heading at t = 0, m
  double vertical_speed = 0.0;     // of the wheel carrier, m/s
  double vertical_momentum = 0.0;  // of all mass that the wheel carries (carrier, rim, added tire), kg m/s
  double carried_mass = 0.0;       // kg, including the tire's added mass
  double joint_drift = 0.0;        // largest constraint violation, m or rad

  /// Acceleration that acts on all that the wheel carries, W, m/s².
  Vec3 gravity = standard_gravity();

  /// Weight on the undisturbed ground of all that the wheel carries, N.
  double load() const { return -carried_mass * gravity.z(); }
};
void visit_fields(FieldsOf<WheelReport> auto& s, auto&& visit) {
  visit(s.slip, Field{"slip"});
  visit(s.speed, Field{"speed", "m/s"});
  visit(s.spin, Field{"spin", "rad/s"});
  visit(s.drive_torque, Field{"drive_torque", "N m"});
  visit(s.lateral_force, Field{"lateral_force", "N"});
  visit(s.aligning_moment, Field{"aligning_moment", "N m"});
  visit(s.axle_height, Field{"axle_height", "m"});
  visit(s.axle_position, Field{"axle_position", "m"});
  visit(s.vertical_speed, Field{"vertical_speed", "m/s"});
  visit(s.vertical_momentum, Field{"vertical_momentum", "kg m/s"});
  visit(s.carried_mass, Field{"carried_mass", "kg"});
  visit(s.joint_drift, Field{"joint_drift", "m or rad"});
  visit(s.gravity, Field{"gravity", "m/s²"});
}

struct LiveNote {
  double speed = std::numeric_limits<double>::quiet_NaN();  // m/s; not a number: the first wheel's speed is shown
  std::string text;                                         // "gear 2"
};

/// A part of the rig with a table of results: a wheel, a body, the vehicle.
struct Subject {
  std::string name;             // of its table: "wheel0", "vehicle"
  std::vector<Column> columns;  // the rig's own, in addition to the columns of every wheel
};

/// Returns wheels without columns of the rig's own.
inline std::vector<Subject> plain_wheels(int count) {
  std::vector<Subject> wheels;
  for (int k = 0; k < count; ++k) wheels.push_back({"wheel" + std::to_string(k), {}});
  return wheels;
}

/// Something that happened during a run and is reported.
struct RigEvent {
  std::string what;                                      // "wheel_lift"
  int wheel = -1;                                        // -1: it concerns no wheel
  double from = 0.0;                                     // s
  double to = std::numeric_limits<double>::quiet_NaN();  // s; not a number: not over yet
};

/// Findings of a rig during a run besides its columns, for the summary.
struct RigFindings {
  std::vector<RigEvent> events;                         // in the order in which they began
  std::vector<std::pair<std::string, double>> figures;  // named after their unit
};

class Rig {
 public:
  virtual ~Rig() = default;

  virtual std::string kind() const = 0;  // "drawbar", …
  virtual int wheel_count() const = 0;

  /// Adds the tire's rigid-body mass properties to the rim of wheel k.
  /// @pre neither placed nor restored; mass ≥ 0, tire_radius > 0
  void add_tire_mass(int wheel, const MassProperties& tire, double tire_radius);

  /// Puts each rim centre at the given height, with the imposed velocities of t = 0. May be called again.
  /// @pre one finite height for each wheel; every tire was added
  void place(std::span<const double> axle_height);

  /// @pre placed or restored
  RimState rim(int wheel) const;
  /// Checks whether the vehicle lies on its side or its roof. Bodies do not touch the ground, so the run ends then.
  virtual bool overturned() const { return false; }

  /// Advances by `duration` in `substeps` steps; the tires' wrenches (about the rim centres, W) are constant.
  /// @returns failure if the constraints cannot be satisfied, or a wrench or a state is not finite
  /// @pre placed or restored; one wrench for each wheel; duration > 0, substeps > 0
  Outcome advance(std::span<const Wrench> wrenches, double duration, int substeps);

  /// Receives z of the lowest point of wheel k's tire and z of the undisturbed ground, m. The node calls it at every
  /// synchronization after the first, before anything is measured.
  virtual void observe(int /*wheel*/, double /*lowest_point*/, double /*ground*/) {}

  /// @pre placed or restored
  WheelReport report(int wheel) const;

  virtual LiveNote live() const { return {}; }
  virtual RigFindings findings() const { return {}; }

  /// @pre placed or restored. @post every member is set and finite
  RigAccounts accounts() const;

  /// Direction in which wheel k travels now, in which its slip, pull and position are measured: unit, W.
  virtual Vec3 heading(int wheel) const = 0;

  /// The wheels in their order, then other subjects; always the same. Subject k below is the k-th of them.
  virtual std::vector<Subject> subjects() const { return plain_wheels(wheel_count()); }
  /// Sets the values of subject k's columns after the last advance, except for those of kind `derived`.
  virtual void measure(int /*subject*/, std::span<double> /*values*/) const {}
  /// Sets the columns of kind `derived` for a line whose other columns are given.
  virtual void derive(int /*subject*/, const LineView& /*line*/, std::span<double> /*values*/) const {}

  /// @pre placed or restored
  void save(Archive& archive) const;
  /// @pre every tire was added. @throws Error(io) if the saved rig had other tires
  void restore(const Archive& archive);
  /// Save and restore the findings. They are not part of the state: nothing that moves depends on them.
  virtual void save_findings(Archive& /*archive*/) const {}
  virtual void restore_findings(const Archive& /*archive*/) {}

 protected:
  struct RigTire {
    MassProperties mass;
    double radius = 0.0;  // undeformed, m
  };
  const RigTire& tire(int wheel) const {
    FURROW_ASSERT(in_range(wheel, tires_.size()), wheel, tires_.size());
    return tires_[wheel];
  }
  bool placed() const { return placed_; }

 private:
  // Each kind of rig overrides these; the function without `do_` checks the preconditions. Saved names begin with
  // "rig/".
  virtual void do_add_tire_mass(int /*wheel*/, const MassProperties& /*tire*/, double /*tire_radius*/) {}
  virtual void do_place(std::span<const double> axle_height) = 0;
  virtual RimState do_rim(int wheel) const = 0;
  virtual Outcome do_advance(std::span<const Wrench> wrenches, double duration, int substeps) = 0;
  virtual WheelReport do_report(int wheel) const = 0;
  virtual RigAccounts do_accounts() const = 0;
  virtual void do_save(Archive& archive) const = 0;
  virtual void do_restore(const Archive& archive) = 0;
  void check_tires() const;
  void check_wheel(int wheel) const;

  std::vector<RigTire> tires_;
  bool placed_ = false;  // or restored
};

}  // namespace furrow::rigs
