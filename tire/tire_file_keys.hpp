// Keys that the files of several tire models share.
#pragma once

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::tire {

namespace keys {
/// A size of the tire, m. Outside these limits, arithmetic on its mesh overflows or underflows.
inline constexpr Allowed kSize = allowed::from(1e-4, 100).usual(0.02, 3);
inline constexpr Key kPressure =
    needed("pressure", "Pa", allowed::from(0).usual(1e3, 2e6), "Inflation, gauge pressure.");
/// A structural damping, s.
inline constexpr Allowed kDampingTime = allowed::from(0).usual(1e-5, 0.2);
inline constexpr Key kContact = needed("contact");
}  // namespace keys

/// The block `contact`: properties of the tread in contact with grains and ground.
struct ContactBlock : ContactMaterial {
  static constexpr SchemaName kSchema{"contact", "What grains and ground feel of the tread."};
};
void visit_fields(FieldsOf<ContactBlock> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.young_modulus,
        needed("young_modulus", "Pa", above(0).usual(1e5, 1e12), "Young's modulus of the tread surface, law mindlin."));
  visit(s.poisson_ratio,
        needed("poisson_ratio", "-", from(0).below(0.5), "Poisson's ratio of the tread surface, law mindlin."));
  visit(s.friction, needed("friction", "-", from(0).usual(0.02, 3), "Coulomb coefficient."));
  visit(s.restitution, needed("restitution", "-", from(0, 1), "Coefficient of restitution, law mindlin."));
  visit(s.normal_stiffness,
        needed("normal_stiffness", "N/m^1.5", above(0).usual(1e3, 1e10), "Normal stiffness, law hertz_tanh."));
  visit(s.normal_damping, needed("normal_damping", "N s/m^1.5", from(0), "Normal damping, law hertz_tanh."));
}

}  // namespace furrow::tire
