// Inflates the undeformed ring on a rim at rest, axisymmetrically: one column of nodes is unknown, the others are the
// same column turned. A layered tire need not be stable as a static body: the steel belts of the reference layup carry
// compressive hoop force at the tread's edges. The equilibrium is therefore approached by creep under the Kelvin–Voigt
// law (no inertia), B(q')ᵀ D̂ [E' + τ ΔE/h] = p ∂V/∂q(q'). Its step h grows while the tangent stays positive definite
// and shrinks when the Cholesky factorization fails.
#pragma once

#include <functional>

#include "tire/ancf/shell_carcass.hpp"

namespace furrow::tire {

struct InflationReport {
  int steps = 0;
  double residual = 0.0;  // of the static equations, relative to the pressure forces
};

/// Coordinates in rim axes, padding filled.
/// @param each_step is called before every step of Newton's method and may throw to stop
/// @throws Error(physics) when the creep ends far from equilibrium.
Field inflate(const ShellCarcass& shell, const ShellMesh& mesh, InflationReport& report,
              const std::function<void()>& each_step = {});

/// The undeformed ring in rim axes, padding filled.
Field undeformed(const ShellMesh& mesh);

}  // namespace furrow::tire
