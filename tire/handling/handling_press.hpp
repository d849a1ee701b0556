// The static test of a handling tire: the spring of its file, on a plate. Its file knows no footprint and no cleat.
#pragma once

#include "tire/handling/coefficients.hpp"
#include "tire/press/press.hpp"

namespace furrow::tire::handling {

/// @throws Error(bad_input) when the ground is not a plate, or the deflection reaches the rim
PressResults press_handling(const MagicFormula& tire, const MassProperties& mass, const PressOptions& options);

}  // namespace furrow::tire::handling
