// Physical constants that all rooms share.
#pragma once

#include "protocol/core/vec.hpp"

namespace furrow {

inline constexpr double kStandardGravity = 9.81;  // m/s²

/// Gravity of a level site, W, m/s². Models are given theirs and take this one where nothing else is said: the world's
/// z is the normal of the undisturbed ground, so that a slope is a tilted gravity.
inline Vec3 standard_gravity() { return {0.0, 0.0, -kStandardGravity}; }

}  // namespace furrow
