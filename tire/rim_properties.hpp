// What a tire file says of the rim that it is mounted on and of what the wheel carries: its block `rim`. Whatever the
// model, tires.cpp reads it.
#pragma once

#include "protocol/core/fields.hpp"

namespace furrow::tire {

/// Negative: the file does not say.
struct RimProperties {
  double mass = -1.0;               // rim with spindle, without tire, kg
  double spin_inertia = -1.0;       // of the rim about its axle, without tire, kg m²
  double diametral_inertia = -1.0;  // of the rim about a diameter, without tire, kg m²
  double carrier_mass = -1.0;       // what the wheel carries besides rim and tire, kg
};

template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<RimProperties> auto& s) {
  visit(Field{"mass", "kg"}, s.mass);
  visit(Field{"spin_inertia", "kg m²"}, s.spin_inertia);
  visit(Field{"diametral_inertia", "kg m²"}, s.diametral_inertia);
  visit(Field{"carrier_mass", "kg"}, s.carrier_mass);
}

}  // namespace furrow::tire
