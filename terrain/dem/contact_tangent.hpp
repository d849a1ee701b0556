// How a grain's force on a tire answers to the tire's motion: the laws of contact_law.hpp differentiated, for a grain
// that stays where it is. What carries the grain gives way as well, so these are upper bounds.
#pragma once

#include <algorithm>
#include <cmath>

#include "terrain/dem/contact_law.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain::dem {

/// A contact whose friction is above this share of its limit slides.
inline constexpr double kSlides = 0.999;
/// Law hertz_tanh: c |v_t| below which tanh is still nearly a dashpot.
inline constexpr double kViscous = 0.5;

/// Mindlin: k_n = dF/dδ = 3/2 K √δ, c_n = c_n δ^{1/4}; where friction holds k_t = 8 G* √(R*δ) and its damping. The
/// change of the dampers with δ is left out. hertz_tanh: k_n = 3/2 k_n √δ, c_n = g_n √δ, while friction is
/// a dashpot c_t = F_t/|v_t|; without its limit it has no stiffness.
template <class Law>
SurfaceContactTangent contact_tangent(const ContactCoefficients& c, const ContactMotion<double>& at,
                                      const ContactForce<double>& f, double share) {
  SurfaceContactTangent t;
  t.normal = Vec3(at.normal.x, at.normal.y, at.normal.z);
  if (!(f.elastic > 0.0)) return t;
  const double s = at.root_overlap;
  const double friction = std::sqrt(dot(f.tangential, f.tangential));
  t.k_n = share * 1.5 * c.stiffness * s;
  if constexpr (Law::kHistory) {
    const double q = std::sqrt(s);
    t.c_n = share * c.damping * q;
    if (friction < kSlides * c.friction * f.elastic) {
      t.k_t = share * c.shear_stiffness * s;
      t.c_t = share * c.shear_damping * q;
    }
  } else {
    t.c_n = share * c.damping * s;
    const double v_n = dot(at.velocity, at.normal);
    const double speed = std::sqrt(std::max(0.0, dot(at.velocity, at.velocity) - v_n * v_n));
    if (c.velocity_scale * speed < kViscous)
      t.c_t = share * std::min(c.friction * f.elastic * c.velocity_scale, c.slip_limit);
  }
  return t;
}

}  // namespace furrow::terrain::dem
