// The optimizer for models that cost much and answer with noise: a space-filling design, a surrogate of every figure
// (surrogate.hpp), and evaluations at the least of the surrogates' misfit until that least stays where it is
// and the surrogates err less there than the targets.
//
// The design is the start and three times as many places as parameters of a sequence of low discrepancy, from a place
// that the seed draws [Roberts 2018]. Each figure has a surrogate of its own. The misfit is Σ (ŷ − data)²/(σ² + σ̂²), σ
// the target's standard error and σ̂ the surrogate's; its least is found from several starts. Both errors are known, so
// none is taken from the residuals: cov s = (JᵀJ)⁻¹.
//
// [Roberts 2018] The unreasonable effectiveness of quasirandom sequences,
// https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences.
#pragma once

#include "nodes/calibrate/objective.hpp"
#include "nodes/calibrate/optimum.hpp"

namespace furrow::calibrate {

/// Asks for at most options.evaluations predictions of the fitted targets. The place that it ends at is one of them.
/// @throws Error(stopped) from the objective, Error(physics) where the model answers at too few places
Optimum optimize_noisy(Objective& objective, const OptimizerOptions& options);

}  // namespace furrow::calibrate
