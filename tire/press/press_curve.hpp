// The force of an inflated tire at rest on flat ground against its deflection, for a vehicle at rest.
//
// Pressing takes seconds, so the curve is kept in the user's cache (press/) for each tire file and each set of a
// scenario's changes. It is as exact as the mesh: see scripts/docs/tire_models.md, "Static pressing".
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct PressCurve {
  double radius = 0.0;                            // of the inflated tire at zero deflection, m
  std::vector<std::pair<double, double>> points;  // deflection, m, and force, N; from (0, 0) on, rising
};

/// The curve up to at least `load`, N, at the pressure of time 0; none for models without a static test.
/// @pre load > 0. @throws Error(physics) naming the tire's file if the tire cannot carry this load
std::optional<PressCurve> press_curve(const TireSpec& tire, double load, const ProgressCall& progress);

/// A load that no tire of this size carries, N: a pressure that no tire has, times width and diameter. Infinite for
/// rigid tires.
double hopeless_load(const TireDescription& tire);

/// The options with a mesh coarse enough for pressing within seconds.
TireOptions coarse_for_pressing(TireOptions options);

}  // namespace furrow::tire
