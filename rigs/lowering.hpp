// How wheels are let down where a scenario does not say it: at the same Froude number whatever their size, as
// drawbar_mount.hpp explains.
#pragma once

namespace furrow::rigs {

inline constexpr double kLoweringFroude = 0.18;  // v/√(g R) at which a wheel is let down
inline constexpr double kLoweringTime = 1.6;     // √(R/g), how long the damper acts

}  // namespace furrow::rigs
