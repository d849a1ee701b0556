// The space that a tire takes around its axis.
#pragma once

#include "tire/tire.hpp"

namespace furrow::tire {

/// Largest distance, over all spin angles, that the inflated tire reaches below the rim's centre, m, at a camber angle
/// `camber`, rad. Places the tire at the origin, at rest. @throws Error(physics) when inflation does not converge
/// @pre |camber| < π/2
double inflated_reach(Tire& tire, double camber);

}  // namespace furrow::tire
