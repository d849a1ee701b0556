// How the coefficients of a contact depend on the sizes of its grains.
//
// `mix` makes them for grains of a reference radius r₀; a contact of other sizes has the same materials, so each
// coefficient follows from its reference by a power law of R*/R₀*, m*/m₀* and I*/I₀* (Eqs. 2–4 of contact_law.hpp):
//   K, k_t ∝ R*^½,   c_n, c_t ∝ (R*^½ m*)^½,   F_c ∝ min(r)²,   μ_r R* ∝ R*,   c_r ∝ (R*^{5/2} I*)^½.
#pragma once

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact_law.hpp"

namespace furrow::terrain::dem {

/// Of a radius in reference radii: the volume and mass in those of the reference grain.
inline double cube(double a) { return a * a * a; }

/// Of a contact against the reference contact, all -.
template <class T>
struct SizeScale {
  T radius;      // R*/R₀*
  T mass;        // m*/m₀*
  T slide_mass;  // of the mass that resists sliding
  T inertia;     // I*/I₀*
  T smaller;     // smaller radius / r₀
};

/// Two grains with radii a r₀ and b r₀.
template <class T>
inline SizeScale<T> pair_scale(T a, T b) {
  const T one = constant<T>(1.0), two = constant<T>(2.0);
  const T q = a / b, q2 = q * q, q3 = q2 * q, a3 = a * a * a;
  SizeScale<T> s;
  s.radius = two * a / (one + q);
  s.mass = s.slide_mass = two * a3 / (one + q3);
  s.inertia = two * (a3 * a * a) / (one + q3 * q2);
  s.smaller = smaller(a, b);
  return s;
}

/// A grain with radius a r₀ against a surface. `share`: mass of the reference grain over that of the piece of surface
/// it moves, 0 for a wall; that piece grows as r².
inline SizeScale<double> surface_scale(double a, double share) {
  FURROW_ASSERT(a > 0.0 && share >= 0.0, a, share);
  const double light = share / (a * a), heavy = 1.0 / (a * a * a);
  return {.radius = a,
          .mass = (1.0 + share) / (heavy + light),
          .slide_mass = (3.5 + share) / (3.5 * heavy + light),
          .inertia = a * a * a * a * a,
          .smaller = a};
}

/// The coefficients of law mindlin for another size; T may hold several contacts. Law hertz_tanh has none: its
/// stiffness is stated for one size.
template <class T, class S>
inline Coefficients<T> scaled(const Coefficients<S>& c, const SizeScale<T>& s) {
  const T zero = constant<T>(0.0), root_r = root(s.radius);
  Coefficients<T> out;
  out.stiffness = c.stiffness * root_r;
  out.damping = c.damping * root(root_r * s.mass);
  out.shear_stiffness = c.shear_stiffness * root_r;
  out.shear_damping = c.shear_damping * root(root_r * s.slide_mass);
  out.friction = zero + c.friction;
  out.cohesion_force = c.cohesion_force * (s.smaller * s.smaller);
  out.velocity_scale = zero + c.velocity_scale;
  out.slip_limit = zero + c.slip_limit;
  out.rolling_arm = c.rolling_arm * s.radius;
  out.rolling_radius = c.rolling_radius * s.radius;
  out.rolling_damping = c.rolling_damping * s.radius * root(root_r * s.inertia);
  out.roll_limit = zero + c.roll_limit;
  return out;
}

}  // namespace furrow::terrain::dem
