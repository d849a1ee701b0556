// How wheels are lowered if a scenario does not set it: at the same Froude number for every size (drawbar_mount.hpp
// explains why).
#pragma once

namespace furrow::rigs {

inline constexpr double kLoweringFroude = 0.18;  // v/√(g R) at which a wheel is lowered
inline constexpr double kLoweringTime = 1.6;     // √(R/g), how long the damper acts

}  // namespace furrow::rigs
