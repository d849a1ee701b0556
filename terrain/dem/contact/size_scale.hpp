// Changes of R*, m* and I* of a contact with the sizes of its two grains.
//
// Coefficients are mixed for grains of a reference radius r₀. A contact of other sizes has the same materials, so each
// coefficient of a law follows from its reference value by a power law of these ratios.
#pragma once

#include "protocol/core/triple.hpp"

namespace furrow::terrain::dem {

/// a³: for a radius in reference radii, volume and mass relative to the reference grain.
template <class T>
FURROW_HD inline T cube(T a) {
  return a * a * a;
}

/// Ratios of a contact to the reference contact, all -.
template <class T>
struct SizeScale {
  T radius;      // R*/R₀*
  T mass;        // m*/m₀*
  T slide_mass;  // ratio of the masses that resist sliding
  T inertia;     // I*/I₀*
  T smaller;     // smaller radius / r₀
};

/// Scale for two grains with radii a r₀ and b r₀; bitwise the same for (b, a).
template <class T>
FURROW_HD inline SizeScale<T> pair_scale(T a, T b) {
  const T two = simd::constant<T>(2.0);
  const T product = a * b, a3 = cube(a), b3 = cube(b);
  SizeScale<T> s;
  s.radius = two * product / (a + b);
  s.mass = s.slide_mass = two * cube(product) / (a3 + b3);
  s.inertia = two * (cube(product) * product * product) / (a3 * a * a + b3 * b * b);
  s.smaller = simd::smaller(a, b);
  return s;
}

/// Scale for a grain with radius a r₀ against a surface. `share`: mass of the reference grain over that of the piece of
/// surface that it moves, 0 for a wall; that piece grows as r². @pre a > 0, share ≥ 0
template <class T>
FURROW_HD inline SizeScale<T> surface_scale(T a, double share) {
  using simd::constant;
  const T light = constant<T>(share) / (a * a), heavy = constant<T>(1.0) / cube(a);
  return {.radius = a,
          .mass = constant<T>(1.0 + share) / (heavy + light),
          .slide_mass = constant<T>(3.5 + share) / (constant<T>(3.5) * heavy + light),
          .inertia = cube(a) * a * a,
          .smaller = a};
}

}  // namespace furrow::terrain::dem
