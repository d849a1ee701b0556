#include "terrain/dem/solver_setup.hpp"

#include <algorithm>
#include <string>
#include <type_traits>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::dem {

Precision precision_from(const std::string& name) {
  if (name == "mixed") return Precision::mixed;
  if (name == "double") return Precision::full;
  throw input_error("scenario", "terrain.precision", "'" + name + "' is unknown, expected mixed or double");
}

SolverParams solver_params(const DemOptions& o) {
  SolverParams p;
  p.law = law_from(o.law);
  p.rolling = o.rolling_friction > 0.0;
  p.gravity = o.gravity;
  p.precision = precision_from(o.precision);
  p.grain = grain_properties(o.radius, o.density);
  p.smallest = smallest_radius(o), p.largest = largest_radius(o);
  p.bin.length = o.length;
  p.bin.width = o.width;
  p.bin.periodic_x = o.periodic_x;
  p.bin.periodic_y = o.periodic_y();
  p.activity = o.activity && with_law(p.law, [&](auto law) { return law.can_rest(o); });
  p.skin = kSkinShare * o.radius;
  p.threads = std::max(1, o.threads);
  return p;
}

SolverParams settling_params(const DemOptions& options) {
  SolverParams p = solver_params(options);
  p.threads = std::max(1, options.settle_threads);
  p.activity = false;
  return p;
}

SolverCoefficients run_coefficients(const DemOptions& options, double step) {
  FURROW_ASSERT(options.radius > 0.0 && options.density > 0.0, options.radius, options.density);
  DemOptions at_step = options;
  at_step.step = step;
  const GrainProperties grain = grain_properties(options.radius, options.density);
  const ContactMaterial material = grain_material(options);
  const ContactCoefficients wall = mix(material, material, Partner::surface, grain, at_step);
  return {mix(material, material, Partner::grain, grain, at_step), wall, wall};
}

ContactCoefficients surface_coefficients(const DemOptions& options, const ContactMaterial& material, double step) {
  DemOptions at_step = options;
  at_step.step = step;
  return mix(grain_material(options), material, Partner::surface, grain_properties(options.radius, options.density),
             at_step);
}

/// The smallest grains are the least stable. A contact of radii r and R = ρ r has R* = ρ/(1 + ρ) r, so it is stiffer
/// than a contact of equal grains: k(ρ)/k(1) = (2ρ/(1 + ρ))^½, at most √2 against a wall, where R* → r. But its partner
/// moves less: with displacements y = √m x, a row of the matrix of accelerations is at most (Gershgorin)
///   Σ k(ρ) (1/m + 1/√(m M)) = Σ 2 k(1)/m · f(ρ),   f(ρ) = (2ρ/(1 + ρ))^½ (1 + ρ^{-3/2})/2 ≤ f(1) = 1,  f(4) = 0.71.
/// So equal neighbours in antiphase, the case of stable_step(), bound the neighbours of every size. Dashpots, with
/// c(ρ)/c(1) = (R*/R₀*)^¼ (m*/m₀*)^½, exceed this bound by at most 1.3 %, at ρ = 1.25.
StableStep stable_at(const DemOptions& options, double overlap) {
  const double radius = smallest_radius(options);
  return stable_step(run_coefficients(of_one_size(options, radius), options.step).pair,
                     grain_properties(radius, options.density), options, overlap);
}

StiffnessKey stiffness_key(DemOptions& options) {
  const std::string name = with_law(law_from(options.law), [](auto law) { return law.kStiffnessKey; });
  StiffnessKey found;
  visit_fields(options, [&](auto& value, const Field& field) {
    if constexpr (std::is_same_v<decltype(value), double&>)
      if (name == field.name) found = {field.name, field.unit, &value};
  });
  FURROW_ASSERT(found.value != nullptr, name);
  return found;
}

double stated_overlap(const DemOptions& options) { return kStatedOverlap * smallest_radius(options); }

}  // namespace furrow::terrain::dem
