// Physical constants that all folders share.
#pragma once

#include <numbers>

#include "protocol/core/vec.hpp"

namespace furrow {

inline constexpr double kStandardGravity = 9.81;             // m/s²
inline constexpr double kDegree = std::numbers::pi / 180.0;  // rad

/// Gravity of a level site, W, m/s²; the default of models that are given no other. The world's z is the normal of the
/// undisturbed ground, so a slope is a tilted gravity.
inline Vec3 standard_gravity() { return {0.0, 0.0, -kStandardGravity}; }

}  // namespace furrow
