// What every tire says of itself at each step, whatever the model: the account that results are made from.
#pragma once

#include <cmath>
#include <limits>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Cumulative account of what a tire did since it was placed. A model must set every member: what it forgets is not a
/// number, and the tire's rank refuses that by name.
struct TireDiagnostics {
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  double kinetic_energy = kMissing;          // J, now
  double strain_energy = kMissing;           // elastic − work of the pressure on the volume, J, now
  double dissipation = kMissing;             // structural damping and relaxation, J, cumulative
  Vec3 momentum = Vec3::Constant(kMissing);  // kg m/s, now
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<TireDiagnostics> auto& s) {
  visit(Field{"kinetic_energy", "J"}, s.kinetic_energy);
  visit(Field{"strain_energy", "J"}, s.strain_energy);
  visit(Field{"dissipation", "J"}, s.dissipation);
  visit(Field{"momentum", "kg m/s"}, s.momentum);
}

/// Name of the first member that is not a finite number; null: all are.
inline const char* first_missing(const TireDiagnostics& diagnostics) {
  const char* name = nullptr;
  visit_fields(
      [&](const Field& field, const auto& value) {
        double sum = 0.0;
        if constexpr (requires { value.sum(); })
          sum = value.sum();
        else
          sum = value;
        if (!name && !std::isfinite(sum)) name = field.name;
      },
      diagnostics);
  return name;
}

}  // namespace furrow
