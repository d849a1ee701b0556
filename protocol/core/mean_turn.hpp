// The turn of a rigid body over a step, as a vector to be used with mean lever arms.
#pragma once

#include "protocol/core/vec.hpp"

namespace furrow {

/// θ with (R' − R) a = θ × ½ (R + R') a for every a that is fixed in the body: along the axis of the turn, 2
/// tan(angle/2) long. So the work of forces at points of a rigid body is exactly force · displacement + moment · θ,
/// with the moment taken about the reference point with mean lever arms. @pre the turn is less than half a revolution
inline Vec3 mean_turn(const Quat& from, const Quat& to) {
  const Quat q = to * from.conjugate();
  return 2.0 / q.w() * q.vec();
}

}  // namespace furrow
