// How a vehicle stands before it meets the ground: at rest in its static trim on hard level ground, each tire under its
// static load, and lifted from there. The tires give way equally in this: they are placed undeformed, so their own
// deflections come as the ground takes the vehicle over.
#pragma once

#include <span>

#include "vehicle/analysis/trim.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::rigs {

/// Puts the vehicle into its trim. @param radii of the tires, m, one for each wheel
/// @throws Error(physics) when there is no equilibrium, or a wheel that carries nothing
vehicle::Trim stand(vehicle::Vehicle& vehicle, std::span<const double> radii);

}  // namespace furrow::rigs
