// The optimizer for models that answer quickly and without noise: Levenberg and Marquardt's method within bounds
// [Ceres Solver 2.1, http://ceres-solver.org], from several starts.
//
// After each solution the parameters that lie at a bound and are pushed against it are held there, the others are
// solved for again, and those that are not pushed any more are let go: what it ends with fulfils the first-order
// conditions of a least under bounds.
#pragma once

#include "nodes/calibrate/objective.hpp"
#include "nodes/calibrate/optimum.hpp"

namespace furrow::calibrate {

/// @throws Error(stopped) from the objective, Error(physics) where the model answers at none of the starts
Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options);

}  // namespace furrow::calibrate
