// The force of an inflated tire on flat ground against its deflection, at rest: what a vehicle stands on.
//
// Pressing takes seconds, so the curve is kept in the user's cache (press/), by the tire's file and by what the
// scenario changes of it. It is as exact as the mesh: see README.md, "Static pressing".
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct PressCurve {
  double radius = 0.0;                            // of the inflated tire, where the deflection begins, m
  std::vector<std::pair<double, double>> points;  // deflection, m, and force, N; from (0, 0) on, rising
};

/// The curve at least up to `load`, N, at the pressure of the time 0; none for models that have no static test.
/// @pre load > 0. @throws Error(physics) naming the tire's file when it carries no such load
std::optional<PressCurve> press_curve(const TireSpec& tire, double load, const ProgressCall& progress);

/// A load that no tire of this size carries, N: a pressure beyond that of any tire, over its width and its diameter.
/// Infinite for rigid tires.
double hopeless_load(const TireDescription& tire);

/// The options with a mesh that is coarse enough to be pressed within seconds.
TireOptions coarse_for_pressing(TireOptions options);

}  // namespace furrow::tire
