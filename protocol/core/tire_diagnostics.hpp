// What every tire says of itself at each step, whatever the model: the account that results are made from.
#pragma once

#include <limits>

#include "protocol/core/fields.hpp"
#include "protocol/core/first_missing.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Account of what a tire holds and lost, each entry from its own formula. A model must set every member: what it
/// forgets is not a number, and the tire's rank refuses that by name. With the works of
/// its rim and of the terrain on it,
///   residual = rim work + terrain work − Δ(kinetic + elastic + pressure + potential) − losses()
/// is what the model's formulas leave over (tire/README.md, Accounts).
struct TireDiagnostics {
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  double kinetic_energy = kMissing;                // J, now
  double elastic_energy = kMissing;                // with what relaxing branches store, J, now
  double pressure_energy = kMissing;               // −p (V − V₀), without what a changing p put there, J, now
  double potential_energy = kMissing;              // of gravity, J, now
  double dissipation = kMissing;                   // structural damping and relaxation, J, cumulative
  double numerical_loss = kMissing;                // to the rule of time integration, J, cumulative
  double solver_loss = kMissing;                   // to what the solver left of its equations, J, cumulative
  Vec3 momentum = Vec3::Constant(kMissing);        // kg m/s, now
  Vec3 solver_impulse = Vec3::Constant(kMissing);  // of the same remainder, N s, cumulative; part of the spindle's

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
