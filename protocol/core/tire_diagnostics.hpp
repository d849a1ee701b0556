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
void visit_fields(auto&& visit, FieldsOf<TireDiagnostics> auto& s) {
  visit(Field{"kinetic_energy", "J"}, s.kinetic_energy);
  visit(Field{"elastic_energy", "J"}, s.elastic_energy);
  visit(Field{"pressure_energy", "J"}, s.pressure_energy);
  visit(Field{"potential_energy", "J"}, s.potential_energy);
  visit(Field{"dissipation", "J"}, s.dissipation);
  visit(Field{"numerical_loss", "J"}, s.numerical_loss);
  visit(Field{"solver_loss", "J"}, s.solver_loss);
  visit(Field{"momentum", "kg m/s"}, s.momentum);
  visit(Field{"solver_impulse", "N s"}, s.solver_impulse);
}

}  // namespace furrow
