#include "terrain/dem/contact/contact_mixing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Mass of a surface that a grain's contact moves: that of the area covered by one of closely packed grains.
double surface_mass(const ContactMaterial& surface, double radius) {
  const double footprint = 2.0 * std::numbers::sqrt3 * radius * radius;
  return surface.area_density > 0.0 ? surface.area_density * footprint : kInfinite;
}

}  // namespace

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
          .pair_friction = -1.0,
          .rolling_friction = -1.0,
          .area_density = 0.0};
}

double MixedPair::cohesion_force() const {
  return std::numbers::pi * radius * radius * std::min(a.cohesion, b.cohesion);
}

ContactCoefficients mix(const ContactMaterial& grain, const ContactMaterial& other, Partner partner,
                        const GrainProperties& properties, const DemOptions& options) {
  FURROW_ASSERT(properties.radius > 0.0 && properties.mass > 0.0, properties.radius, properties.mass);
  const bool pair = partner == Partner::grain;
  const double r = properties.radius;
  const double other_mass = pair ? properties.mass : surface_mass(other, r);
  const MixedPair mixed{
      .a = grain,
      .b = other,
      .radius = r,
      .reduced_radius = pair ? 0.5 * r : r,
      .mass = 1.0 / (1.0 / properties.mass + 1.0 / other_mass),
      // Sliding also spins the spheres, which then resist like 2/7 of their mass.
      .slide_mass = 1.0 / (3.5 / properties.mass + (pair ? 3.5 : 1.0) / other_mass),
      .inertia = pair ? 0.5 * properties.inertia : properties.inertia,
      .friction = other.pair_friction >= 0.0 ? other.pair_friction : std::min(grain.friction, other.friction),
      .rolling = other.rolling_friction >= 0.0 ? other.rolling_friction : options.rolling_friction,
  };
  return with_law(law_from(options.law), [&](auto law) { return ContactCoefficients(law.mix(mixed, options)); });
}

double mass_share(const GrainProperties& grain, const ContactMaterial& surface) {
  FURROW_ASSERT(grain.radius > 0.0 && surface.area_density >= 0.0, grain.radius, surface.area_density);
  return grain.mass / surface_mass(surface, grain.radius);
}

StableStep stable_step(const ContactCoefficients& pair, const GrainProperties& grain, const DemOptions& options,
                       double overlap) {
  FURROW_ASSERT(overlap > 0.0 && grain.mass > 0.0, overlap, grain.mass);
  return with_law(law_from(options.law),
                  [&](auto law) { return law.stable_step(pair.of<decltype(law)>(), options, grain.mass, overlap); });
}

void check_material(const ContactMaterial& material, LawKind kind, int index) {
  const auto require = [&](const char* key, double value, bool fits, const char* expected) {
    if (!fits || !std::isfinite(value))
      throw input_error(fmt::format("surface {}", index), fmt::format("contact.{}", key),
                        fmt::format("is {:g}, expected {} for law '{}'", value, expected, law_name(kind)));
  };
  require("friction", material.friction, material.friction >= 0.0, "0 or more");
  with_law(kind, [&](auto law) { law.check(material, require); });
}

}  // namespace furrow::terrain::dem
