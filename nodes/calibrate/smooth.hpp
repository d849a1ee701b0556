// The optimizer for models that answer quickly and without noise: bounded least squares (least_squares.hpp) from
// several starts.
#pragma once

#include "nodes/calibrate/objective.hpp"
#include "nodes/calibrate/optimum.hpp"

namespace furrow::calibrate {

/// @throws Error(stopped) from the objective, Error(physics) where the model answers at none of the starts
Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options);

}  // namespace furrow::calibrate
