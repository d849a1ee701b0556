// The material of a planar tire: an elastic solid in plane strain with a viscous part.
//
// Cauchy stress with the deformation gradient F, B = F Fᵀ, J = |F|, and the rate of deformation D:
//   T = μ/J (B − I) + κ (J − 1/J) I + ξ D,   κ = λ/2                                                           (1)
// It is the derivative of the energy per undeformed volume
//   W = μ/2 (tr B − 2 − 2 ln J) + κ/2 (J² − 1 − 2 ln J)                                                        (2)
// As J − 1/J ≈ 2 tr ε, κ = λ/2 gives Hooke's law for small strains. The source prints G = ½(B − I) and
// T = 2μ G/J + λ (J − 1/J) I + ξ D, which is κ = λ: this doubles λ, so ν = 0.45 acts like ν = 0.474.
//
// Štiavnický, Enhanced tire model for vibration analysis of vehicle, Science & Military 2/2010.
#pragma once

#include "protocol/core/assert.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"

namespace furrow::tire {

/// κ in (1): λ/2 (consistent), or λ (as printed in the source).
enum class PlanarLaw { printed, consistent };

struct PlanarMaterial {
  static constexpr SchemaName kSchema{"planar_material", "An elastic and viscous material in plane strain."};
  double density = 0.0;        // kg/m³
  double young_modulus = 0.0;  // Pa
  double poisson_ratio = 0.0;
  double viscosity = 0.0;  // ξ, Pa s
};
void visit_fields(FieldsOf<PlanarMaterial> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.density, needed("density", "kg/m³", above(0).usual(10, 2e4), "Density."));
  visit(s.young_modulus, needed("young_modulus", "Pa", above(0).usual(1e4, 1e12), "Young's modulus."));
  // Above this limit the largest stable step vanishes.
  visit(s.poisson_ratio, needed("poisson_ratio", "-", from(0, 0.499), "Poisson's ratio."));
  visit(s.viscosity, needed("viscosity", "Pa s", from(0), "Viscosity xi: stress / rate of deformation."));
}

struct PlanarModuli {
  double mu = 0.0, kappa = 0.0;  // Pa
};

inline PlanarModuli planar_moduli(const PlanarMaterial& m, PlanarLaw law) {
  FURROW_ASSERT(m.young_modulus > 0.0 && m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5, m.young_modulus,
                m.poisson_ratio);
  const double mu = 0.5 * m.young_modulus / (1.0 + m.poisson_ratio);
  const double lambda = 2.0 * mu * m.poisson_ratio / (1.0 - 2.0 * m.poisson_ratio);
  return {mu, law == PlanarLaw::printed ? lambda : 0.5 * lambda};
}

}  // namespace furrow::tire
