// The spindle wrench for a rig that carries a tire's rigid-body mass as added mass.
#pragma once

#include "nodes/ranks/node.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::ranks {

/// Angular momentum of the rigid body about the rim's centre, W.
inline Vec3 spin_momentum(const MassProperties& mass, const RimState& rim) {
  const Mat3 r = rim.orientation.toRotationMatrix();
  return r * (mass.inertia * (r.transpose() * rim.angular_velocity));
}

/// The complete spindle wrench without the tire's own rigid-body inertia and weight:
///   F_sent = F + m (Δv/H − g),   M_sent = M + Δ(R J Rᵀ ω)/H
/// @pre duration > 0
inline Wrench carried_wrench(const Wrench& spindle, const MassProperties& mass, const RimState& from,
                             const RimState& to, double duration, const Vec3& gravity) {
  FURROW_ASSERT(duration > 0.0 && mass.mass >= 0.0, duration, mass.mass);
  Wrench sent;
  sent.force = spindle.force + mass.mass * (to.velocity - from.velocity) / duration - mass.mass * gravity;
  sent.moment = spindle.moment + (spin_momentum(mass, to) - spin_momentum(mass, from)) / duration;
  return sent;
}

}  // namespace furrow::ranks
