// Laws of springs and shock absorbers from tables, for the distance x between their two ends. Positive forces push the
// ends apart.
//
//   spring F = f(L₀ − x) + stop(x_min − x) − stop(x − x_max), with its energy; the stops act beyond x_min and x_max
//   shock F = −c(x, v) v. Between its two marks c is `bump` (v < 0) or `rebound` (v > 0), outside `outer_bump` or
//            `outer_rebound`. It changes at a mark by the smoothstep over the length `blend_length` about it, and
//            between bump and rebound linearly for |v| < blend_speed / 2. As c ≥ 0 everywhere, a shock absorber only
//            takes energy; all of it is dissipated.
#pragma once

#include <limits>
#include <optional>

#include "vehicle/multibody/force_element.hpp"
#include "vehicle/multibody/table.hpp"

namespace furrow::vehicle {

struct SpringOptions {
  std::optional<Table> force;  // N against deflection L₀ − x, m
  double free_length = 0.0;    // L₀, m
  std::optional<Table> stop;   // N against the distance beyond x_min or x_max, m; begins at (0, 0) and rises
  double shortest = 0.0, longest = std::numeric_limits<double>::infinity();  // x_min, x_max, m
};

/// @throws Error(physics) where the options contradict each other
ForceLaw tabulated_spring(const SpringOptions& options);

struct ShockOptions {
  double bump = 0.0, rebound = 0.0;                              // N s/m
  double outer_bump = 0.0, outer_rebound = 0.0;                  // N s/m; used only with marks
  double first_mark = -std::numeric_limits<double>::infinity();  // m
  double last_mark = std::numeric_limits<double>::infinity();
  double blend_length = 0.0;  // m, > 0 if there is a mark
  double blend_speed = 0.0;   // m/s; 0: the coefficient jumps at v = 0, where the force is zero
};

/// c(x, v), N s/m.
double shock_coefficient(const ShockOptions& options, double length, double speed);
/// @throws Error(physics) where the options contradict each other
ForceLaw shock_absorber(const ShockOptions& options);

}  // namespace furrow::vehicle
