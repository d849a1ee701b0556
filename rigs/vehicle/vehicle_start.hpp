// The vehicle before it touches the ground: in its static trim on hard ground at the run's slope, each tire under its
// static load, and lifted from there. If it cannot stand on all its wheels on that slope, it starts as on level ground.
// All tires have the same relative deflection in the trim. They are placed undeformed, so their own deflections develop
// as the ground takes over the vehicle's weight.
#pragma once

#include <span>

#include "vehicle/analysis/trim.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// Puts the vehicle into its trim. @param radii of the tires, m, one for each wheel
/// @param heading by which the vehicle will be turned, relative to the uphill direction, rad
/// @throws Error(physics) if there is no equilibrium, or a wheel carries nothing
vehicle::Trim stand(vehicle::Vehicle& vehicle, std::span<const double> radii, double heading);

}  // namespace furrow::rigs
