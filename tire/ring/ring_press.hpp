// The static test of the flexible ring: its load–deflection curve and the pressure along its centre line, on a plate, a
// bar or a profile. Deflection is how far the ground's highest point stands above the inflated ring's lowest.
#pragma once

#include <string>

#include "tire/press/press.hpp"
#include "tire/ring/ring_solver.hpp"

namespace furrow::tire {

/// @param rim_radius m, that the belt must not reach
/// @throws Error(bad_input) when the deflection is beyond kMostRingDeflection, Error(physics) without an equilibrium
PressResults press_ring(const RingParams& params, double rim_radius, const MassProperties& mass,
                        const PressOptions& options, const ProgressCall& progress);

/// Pressure at the segments that touch, and where corners carry the belt: their force spread over one segment.
std::vector<PressSample> ring_footprint(const RingSolver& solver);

}  // namespace furrow::tire
