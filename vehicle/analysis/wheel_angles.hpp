// Angles of a wheel and its steering axis in the vehicle's frame. With the spin axis a (unit, to the left), the
// steering axis u (unit, upward) and s = +1 on the left, −1 on the right:
//
//   camber   asin(−s a_z)            positive: the top leans outward
//   toe      s atan2(a_x, a_y)       positive: toe-in
//   steer    −atan2(a_x, a_y)        positive: to the left
//   caster   atan2(−u_x, u_z)        positive: the top leans backward
//   kingpin  atan2(−s u_y, u_z)      positive: the top leans inward
//
// The wheel touches the ground at the lowest point of its middle circle.
#pragma once

#include <algorithm>
#include <cmath>

#include "protocol/core/vec.hpp"

namespace furrow::vehicle {

inline double camber_angle(const Vec3& a, double side) { return std::asin(std::clamp(-side * a.z(), -1.0, 1.0)); }
inline double toe_angle(const Vec3& a, double side) { return side * std::atan2(a.x(), a.y()); }
inline double steer_angle(const Vec3& a) { return -std::atan2(a.x(), a.y()); }
inline double caster_angle(const Vec3& u) { return std::atan2(-u.x(), u.z()); }
inline double kingpin_angle(const Vec3& u, double side) { return std::atan2(-side * u.y(), u.z()); }

/// From the wheel's centre to its lowest point: unit. @pre the axle is not upright
inline Vec3 down_in_wheel(const Vec3& a) { return (a.z() * a - Vec3::UnitZ()).normalized(); }

}  // namespace furrow::vehicle
