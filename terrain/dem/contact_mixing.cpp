#include "terrain/dem/contact_mixing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// β of Eq. (2) of contact_law.hpp.
double damping_ratio(double restitution) {
  if (restitution <= 0.0) return 1.0;
  const double l = std::log(std::min(restitution, 1.0));
  return -l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
}

double effective_young(const ContactMaterial& a, const ContactMaterial& b) {
  FURROW_ASSERT(a.young_modulus > 0.0 && b.young_modulus > 0.0, a.young_modulus, b.young_modulus);
  return 1.0 / ((1.0 - a.poisson_ratio * a.poisson_ratio) / a.young_modulus +
                (1.0 - b.poisson_ratio * b.poisson_ratio) / b.young_modulus);
}

double effective_shear(const ContactMaterial& a, const ContactMaterial& b) {
  FURROW_ASSERT(a.poisson_ratio > -1.0 && b.poisson_ratio > -1.0, a.poisson_ratio, b.poisson_ratio);
  return 1.0 / (2.0 * (2.0 - a.poisson_ratio) * (1.0 + a.poisson_ratio) / a.young_modulus +
                2.0 * (2.0 - b.poisson_ratio) * (1.0 + b.poisson_ratio) / b.young_modulus);
}

/// What a grain's contact moves of a surface: its mass over the area that one of closely packed grains covers.
double surface_mass(const ContactMaterial& surface, double radius) {
  const double footprint = 2.0 * std::numbers::sqrt3 * radius * radius;
  return surface.area_density > 0.0 ? surface.area_density * footprint : kInfinite;
}

}  // namespace

LawKind law_from(const std::string& name) {
  if (name == "mindlin") return LawKind::mindlin;
  if (name == "hertz_tanh" || name == "coulomb") return LawKind::hertz_tanh;
  throw input_error("scenario", "terrain.law", "'" + name + "' is unknown, expected mindlin or hertz_tanh");
}

const char* law_name(LawKind law) { return law == LawKind::mindlin ? "mindlin" : "hertz_tanh"; }

GrainProperties grain_properties(double radius, double density) {
  FURROW_ASSERT(radius > 0.0 && density > 0.0, radius, density);
  const double mass = density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return {.radius = radius, .mass = mass, .inertia = 0.4 * mass * radius * radius};
}

ContactMaterial grain_material(const DemOptions& o) {
  return {.young_modulus = o.young_modulus,
          .poisson_ratio = o.poisson_ratio,
          .friction = o.friction,
          .restitution = o.restitution,
          .normal_stiffness = o.normal_stiffness,
          .normal_damping = o.normal_damping,
          .cohesion = o.cohesion,
          .area_density = 0.0};
}

LawSettings law_settings(const DemOptions& o) {
  return {.kind = law_from(o.law),
          .rolling_friction = o.rolling_friction,
          .velocity_scale = o.friction_velocity_scale,
          .friction_impulse_limit = o.friction_impulse_limit,
          .step = o.step};
}

ContactCoefficients mix(const ContactMaterial& grain, const ContactMaterial& other, Partner partner,
                        const GrainProperties& properties, const LawSettings& law) {
  FURROW_ASSERT(properties.radius > 0.0 && properties.mass > 0.0, properties.radius, properties.mass);
  FURROW_ASSERT(law.kind == LawKind::mindlin || !law.friction_impulse_limit || law.step > 0.0, law.step);
  const bool pair = partner == Partner::grain;
  const double r = properties.radius, r_star = pair ? 0.5 * r : r;
  const double other_mass = pair ? properties.mass : surface_mass(other, r);
  const double m_star = 1.0 / (1.0 / properties.mass + 1.0 / other_mass);
  // Sliding also spins the spheres, which resist as 2/7 of their mass.
  const double m_slide = 1.0 / (3.5 / properties.mass + (pair ? 3.5 : 1.0) / other_mass);
  const double i_star = pair ? 0.5 * properties.inertia : properties.inertia;

  ContactCoefficients c;
  c.friction = std::min(grain.friction, other.friction);
  c.cohesion_force = std::numbers::pi * r * r * std::min(grain.cohesion, other.cohesion);
  c.velocity_scale = law.velocity_scale;
  c.rolling_arm = law.rolling_friction * r_star;
  c.rolling_radius = r_star;
  c.slip_limit = c.roll_limit = kInfinite;
  if (law.kind == LawKind::hertz_tanh) {
    c.stiffness = 0.5 * (grain.normal_stiffness + other.normal_stiffness);
    c.damping = 0.5 * (grain.normal_damping + other.normal_damping);
    if (law.friction_impulse_limit) {
      c.slip_limit = kImpulseShare * m_slide / law.step;
      c.roll_limit = kImpulseShare * i_star / law.step;
    }
    return c;
  }
  const double e_star = effective_young(grain, other), g_star = effective_shear(grain, other);
  const double root_r = std::sqrt(r_star);
  const double beta = damping_ratio(std::min(grain.restitution, other.restitution));
  c.stiffness = 4.0 / 3.0 * e_star * root_r;
  c.shear_stiffness = 8.0 * g_star * root_r;
  const double factor = 2.0 * std::sqrt(5.0 / 6.0) * beta;
  c.damping = factor * std::sqrt(2.0 * e_star * root_r * m_star);
  c.shear_damping = factor * std::sqrt(c.shear_stiffness * m_slide);
  c.rolling_damping = 2.0 * kRollingDampingRatio * std::sqrt(c.shear_stiffness * r_star * r_star * i_star);
  return c;
}

double mass_share(const GrainProperties& grain, const ContactMaterial& surface) {
  FURROW_ASSERT(grain.radius > 0.0 && surface.area_density >= 0.0, grain.radius, surface.area_density);
  return grain.mass / surface_mass(surface, grain.radius);
}

// A bed of z = 6 contacts per grain in random directions, stiffness k_n = 3/2 K √δ and k_t. With Σ n nᵀ = z/3 I and
// neighbours in antiphase the stiffest modes of translation and of rotation (I = 2/5 m r²) are
//   ω² = 2 z/3 (k_n + 2 k_t)/m   and   ω² = 2 z (2/3) (5/2) k_t/m,     likewise γ with the dashpots;
// the larger of each is taken. v ← v − dt (γ v + ω² x), x ← x + dt v is stable for ω² dt² + 2 γ dt < 4.
// The impulse limit of law hertz_tanh makes friction a dashpot c_t = β m/(7 dt), which takes its part of the 4.
// Friction without history or limit is a dashpot c μ F_e at small |v_t|: 7 c μ F_e dt / m < 2 between equal spheres.
StableStep stable_step(const ContactCoefficients& pair, const GrainProperties& grain, const LawSettings& law,
                       double overlap) {
  FURROW_ASSERT(overlap > 0.0 && pair.stiffness > 0.0, overlap, pair.stiffness);
  FURROW_ASSERT(grain.mass > 0.0, grain.mass);
  const double s = std::sqrt(overlap), q = std::sqrt(s), m = grain.mass;
  const bool history = law.kind == LawKind::mindlin;
  const auto stiffest = [&](double normal, double shear) {
    constexpr double kContacts = 6.0;
    return 2.0 * kContacts / 3.0 / m * std::max(normal + 2.0 * shear, 5.0 * shear);
  };
  const double omega2 = s * stiffest(1.5 * pair.stiffness, pair.shear_stiffness);
  const double gamma = (history ? q : s) * stiffest(pair.damping, pair.shear_damping);
  const bool limited = !history && law.friction_impulse_limit;
  const double room = 4.0 - (limited ? 2.0 * stiffest(0.0, kImpulseShare * m / 7.0) : 0.0);
  StableStep out;
  out.step = (std::sqrt(gamma * gamma + room * omega2) - gamma) / omega2;
  out.reason = gamma * gamma > omega2 ? "damping" : "stiffness";
  if (!history && !law.friction_impulse_limit && pair.friction > 0.0) {
    const double bearing = pair.stiffness * s * overlap;
    const double viscous = 2.0 * m / (7.0 * law.velocity_scale * pair.friction * bearing);
    if (viscous < out.step) out = {viscous, "friction viscosity"};
  }
  return out;
}

}  // namespace furrow::terrain::dem
