// The static test of the flexible ring: its load–deflection curve and the pressure along its centre line, on a plate, a
// bar or a profile. Deflection is the height of the ground's highest point above the inflated ring's lowest.
#pragma once

#include <string>

#include "tire/press/press.hpp"
#include "tire/ring/ring_solver.hpp"

namespace furrow::tire {

/// @param rim_radius that the belt must not reach, m
/// @throws Error(bad_input) when the deflection is beyond kMostRingDeflection, Error(physics) without an equilibrium
PressResults press_ring(const RingParams& params, double rim_radius, const MassProperties& mass,
                        const PressOptions& options, const ProgressCall& progress);

/// Pressure at touching segments and at corners that carry the belt. A corner's force is spread over one segment.
std::vector<PressSample> ring_footprint(const RingSolver& solver);

}  // namespace furrow::tire
