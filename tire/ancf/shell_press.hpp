// The static test of the layered shell.
#pragma once

#include "tire/press/press.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

/// @pre points > 0, deflection > 0, no profile. @throws Error(physics) when there is no equilibrium
PressResults press_tire(const TireFile& file, const PressOptions& options, const ProgressCall& progress);

}  // namespace furrow::tire
