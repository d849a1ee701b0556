// Gears as rows in speeds (rate_row.hpp), without losses. Speeds are relative to the bodies that carry the shafts. The
// difference of the shafts' torques acts on these bodies.
#pragma once

#include <string>

#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {

/// Gear: u_out = ratio · u_in, so the output carries 1/ratio of the input's torque. @throws Error(physics) for ratio 0
int add_gear(System& system, const std::string& name, int in, int out, double ratio);

/// Open differential: u_box = share u_first + (1 − share) u_second; `share` of the box's torque goes to `first`.
/// @throws Error(physics) unless 0 < share < 1
int add_differential(System& system, const std::string& name, int box, int first, int second, double share = 0.5);

/// Makes a shaft turn with a body about an axis fixed in the body (W now), both relative to the shaft's carrier: the
/// drive shaft of a wheel.
int add_shaft_to_body(System& system, const std::string& name, int shaft, int body, const Vec3& axis);

}  // namespace furrow::vehicle
