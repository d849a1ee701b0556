// Energy and momentum of a rig, the same for every kind.
#pragma once

#include <limits>

#include "protocol/core/field_arithmetic.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/first_missing.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::rigs {

/// Account of all bodies of a rig, including the tires' added masses. Each entry has its own formula and is cumulative
/// since the rig was placed, unless marked "now". A rig must set every member: the rig's rank names a missing one,
/// which is not a number, and refuses it. The residuals
///   energy:    drive_work + tow_work + guide_work + tire_work − Δ(kinetic + potential) − damper_loss,
///   momentum:  Δmomentum − gravity_impulse − guide_impulse − tire_impulse,
/// are the error of the rig's step, and round-off.
struct RigAccounts {
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  double kinetic_energy = kMissing;                 // J, now
  double potential_energy = kMissing;               // of gravity and of the rig's springs, J, now
  double drive_work = kMissing;                     // by the drive of the wheels; for a vehicle, by its engine
  double tow_work = kMissing;                       // by the drive that moves the rig along against the tires' pull, J
  double guide_work = kMissing;                     // by rails, steering and all other imposed motion, J
  double tire_work = kMissing;                      // by the tires' wrenches as the rig received them, J
  double damper_loss = kMissing;                    // by dampers and brakes, and in the driveline, J
  Vec3 momentum = Vec3::Constant(kMissing);         // kg m/s, now
  Vec3 gravity_impulse = Vec3::Constant(kMissing);  // N s
  Vec3 guide_impulse = Vec3::Constant(kMissing);    // by the ground through rails and drives, N s
  Vec3 tire_impulse = Vec3::Constant(kMissing);     // by the tires as the rig received it, N s

  double stored() const { return kinetic_energy + potential_energy; }
  /// Returns an account with all members 0, to count from.
  static RigAccounts none();
};
void visit_fields(FieldsOf<RigAccounts> auto& s, auto&& visit) {
  visit(s.kinetic_energy, Field{"kinetic_energy", "J"});
  visit(s.potential_energy, Field{"potential_energy", "J"});
  visit(s.drive_work, Field{"drive_work", "J"});
  visit(s.tow_work, Field{"tow_work", "J"});
  visit(s.guide_work, Field{"guide_work", "J"});
  visit(s.tire_work, Field{"tire_work", "J"});
  visit(s.damper_loss, Field{"damper_loss", "J"});
  visit(s.momentum, Field{"momentum", "kg m/s"});
  visit(s.gravity_impulse, Field{"gravity_impulse", "N s"});
  visit(s.guide_impulse, Field{"guide_impulse", "N s"});
  visit(s.tire_impulse, Field{"tire_impulse", "N s"});
}

inline RigAccounts RigAccounts::none() {
  return combined(RigAccounts(), RigAccounts(), [](auto value, const auto&) {
    if constexpr (requires { value.setZero(); })
      value.setZero();
    else
      value = 0.0;
    return value;
  });
}

/// Adds the work (mean force times displacement) and the impulse of a tire's wrench over a step h.
inline void add_tire(RigAccounts& a, const RimState& from, const RimState& to, const Wrench& wrench, double h) {
  a.tire_work +=
      wrench.force.dot(to.position - from.position) + wrench.moment.dot(mean_turn(from.orientation, to.orientation));
  a.tire_impulse += h * wrench.force;
}

}  // namespace furrow::rigs
