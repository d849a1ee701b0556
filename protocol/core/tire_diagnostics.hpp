// Diagnostics that every tire reports at each step, whatever its model; results are made from them.
#pragma once

#include <limits>

#include "protocol/core/fields.hpp"
#include "protocol/core/first_missing.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Energy and momentum of a tire and its losses, each entry from its own formula. A model must set every member: one
/// that it does not set stays "not a number", and the tire's rank refuses it and names it. With the works of the rim
/// and of the terrain on the tire, the formulas leave the residual
///   residual = rim work + terrain work − Δ(kinetic + elastic + pressure + potential) − losses()
/// (scripts/docs/tire_models.md, Accounts).
struct TireDiagnostics {
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  double kinetic_energy = kMissing;                // J, now
  double elastic_energy = kMissing;                // including energy stored in relaxing branches, J, now
  double pressure_energy = kMissing;               // −p (V − V₀), without energy from a changing p, J, now
  double potential_energy = kMissing;              // of gravity, J, now
  double dissipation = kMissing;                   // structural damping and relaxation, J, cumulative
  double numerical_loss = kMissing;                // by the rule of time integration, J, cumulative
  double solver_loss = kMissing;                   // by the solver's remaining error in its equations, J, cumulative
  Vec3 momentum = Vec3::Constant(kMissing);        // kg m/s, now
  Vec3 solver_impulse = Vec3::Constant(kMissing);  // of the same error, N s, cumulative; part of the spindle's

  double strain_energy() const { return elastic_energy + pressure_energy; }
  double stored() const { return kinetic_energy + strain_energy() + potential_energy; }
  double losses() const { return dissipation + numerical_loss + solver_loss; }
};
void visit_fields(FieldsOf<TireDiagnostics> auto& s, auto&& visit) {
  visit(s.kinetic_energy, Field{"kinetic_energy", "J"});
  visit(s.elastic_energy, Field{"elastic_energy", "J"});
  visit(s.pressure_energy, Field{"pressure_energy", "J"});
  visit(s.potential_energy, Field{"potential_energy", "J"});
  visit(s.dissipation, Field{"dissipation", "J"});
  visit(s.numerical_loss, Field{"numerical_loss", "J"});
  visit(s.solver_loss, Field{"solver_loss", "J"});
  visit(s.momentum, Field{"momentum", "kg m/s"});
  visit(s.solver_impulse, Field{"solver_impulse", "N s"});
}

}  // namespace furrow
