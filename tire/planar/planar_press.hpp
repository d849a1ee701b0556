// The static test of the planar tire: its load–deflection curve and the pressure along its footprint, on a plate, a bar
// with vertical sides or a profile, without friction. The wheel's centre node is held. Deflection is the height of the
// ground's highest point above the undeformed tire's lowest.
#pragma once

#include "tire/planar/planar_static.hpp"
#include "tire/press/press.hpp"

namespace furrow::tire {

/// Largest deflection, share of the height of the tire over its rim.
inline constexpr double kMostPlanarDeflection = 0.6;

/// @throws Error(bad_input) when the deflection is beyond kMostPlanarDeflection, Error(physics) without an equilibrium
PressResults press_planar(const PlanarParams& params, const MassProperties& mass, const PressOptions& options,
                          const ProgressCall& progress);

/// Pressure where nodes and corners touch, their forces spread over a side of the tire.
std::vector<PressSample> planar_footprint(const PlanarStatic& wheel);

}  // namespace furrow::tire
