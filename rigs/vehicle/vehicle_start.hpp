// How a vehicle stands before it meets the ground: at rest in its static trim on hard ground at the slope of the run,
// each tire under its static load, and lifted from there. Where it cannot stand on all its wheels on that slope, it
// starts as on level ground. The tires give way equally in this: they are placed undeformed, so their own deflections
// come as the ground takes the vehicle over.
#pragma once

#include <span>

#include "vehicle/analysis/trim.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// Puts the vehicle into its trim. @param radii of the tires, m, one for each wheel
/// @param heading that it will be turned by, against the way up the slope, rad
/// @throws Error(physics) when there is no equilibrium, or a wheel that carries nothing
vehicle::Trim stand(vehicle::Vehicle& vehicle, std::span<const double> radii, double heading);

}  // namespace furrow::rigs
