// The block `rim` of a tire file: the rim, and the mass that the wheel carries. tires.cpp reads it for every model.
#pragma once

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"

namespace furrow::tire {

/// Negative: the file does not state it.
struct RimProperties {
  static constexpr SchemaName kSchema{"rim",
                                      "The rim that the tire is mounted on and what the wheel carries. A scenario that "
                                      "states the keys of its rig does not need it."};
  double mass = -1.0;               // rim with spindle, without tire, kg
  double spin_inertia = -1.0;       // of the rim about its axle, without tire, kg m²
  double diametral_inertia = -1.0;  // of the rim about a diameter, without tire, kg m²
  double carrier_mass = -1.0;       // that the wheel carries besides rim and tire, kg
};

void visit_fields(FieldsOf<RimProperties> auto& s, auto&& visit) {
  constexpr Allowed kPositive = allowed::above(0).optional();
  visit(s.mass,
        key("mass", "kg", kPositive, "Mass of the rim with its spindle, without the tire; rig.rim_mass overrides it."));
  visit(s.spin_inertia,
        key("spin_inertia", "kg m²", kPositive,
            "Moment of inertia of the rim about its axle, without the tire; rig.rim_spin_inertia overrides it."));
  visit(s.diametral_inertia,
        key("diametral_inertia", "kg m²", kPositive,
            "Moment of inertia of the rim about a diameter, without the tire; rig.rim_diametral_inertia overrides it. "
            "The "
            "default is half of the spin inertia, as of a thin ring."));
  visit(s.carrier_mass,
        key("carrier_mass", "kg", kPositive,
            "Mass that the wheel carries besides rim and tire; rig.load and rig.carrier_mass override it."));
}

}  // namespace furrow::tire
