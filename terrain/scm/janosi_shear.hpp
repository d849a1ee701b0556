// Shear stress between a surface and the soil under one node: Mohr and Coulomb's limit,
// mobilized after Janosi & Hanamoto.
//
//   τ = τ_max (1 − exp(−j/K)),   τ_max = min(c + p tan φ, μ p)                             [Janosi & Hanamoto 1961]
//
// taken as a rate, so that j may change its direction and p may change meanwhile: with the mobilized share m = τ/τ_max,
//
//   ṁ = (v̂ − m) |v|/K
//
// for the sliding velocity v of the surface, v̂ = v/|v|. For a v of constant direction that is m = 1 − exp(−j/K),
// whatever p does; |m| ≤ 1 always; on reversal the stress turns over the same length K, and sliding to and fro gives
// back no more than was stored (Dahl's friction). μ is the friction of surface against soil: rubber cannot hand
// over more.
//
// What is stored per area is ½ K τ_max |m|². Of the work τ·v the rest, τ_max |m|² |v| ≥ 0, is lost by sliding. Where
// τ_max changes, stored energy comes or goes without work: booked as opening.
//
// [Janosi & Hanamoto 1961] The analytical determination of drawbar pull as a function of slip for tracked vehicles,
//   Proc. 1st Int. Conf. Mechanics of Soil–Vehicle Systems, Turin.
#pragma once

#include "protocol/core/vec.hpp"

namespace furrow::terrain::scm {

struct ShearLaw {
  double cohesion = 0.0;  // c, Pa
  double tan_phi = 0.0;   // -
  double K = 0.01;        // m
  double friction = 1.0;  // μ of surface against soil, -

  /// τ_max under the pressure p ≥ 0, Pa.
  double limit(double pressure) const;
  /// ½ K τ_max |m|², J/m².
  double stored(double limit, const Vec3& mobilized) const;
};

struct ShearStep {
  Vec3 mean = Vec3::Zero();  // of m over the step
  double sliding = 0.0;      // ∫ |m|² |v| dt, m: times τ_max what is lost, J/m²
};

/// Advances m over dt with the sliding velocity v, exactly for a constant v. @pre dt > 0, law.K > 0
ShearStep shear(const ShearLaw& law, const Vec3& velocity, double dt, Vec3& mobilized);

}  // namespace furrow::terrain::scm
