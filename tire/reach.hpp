// How much room a tire takes around its axis.
#pragma once

#include "tire/tire.hpp"

namespace furrow::tire {

/// How far the inflated tire reaches below the rim's centre, whatever its spin angle, m, its wheel leaning by `camber`,
/// rad. Places the tire at the origin, at rest. @throws Error(physics) when inflation does not converge
/// @pre |camber| < π/2
double inflated_reach(Tire& tire, double camber);

}  // namespace furrow::tire
