// Coefficients of a contact from the materials, and the stable step of a bed of such contacts.
#pragma once

#include <string>

#include "protocol/core/surface.hpp"
#include "terrain/dem/contact/laws.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

struct GrainProperties {
  double radius = 0.0;   // m
  double mass = 0.0;     // kg
  double inertia = 0.0;  // 2/5 m r², kg m²
};
GrainProperties grain_properties(double radius, double density);

ContactMaterial grain_material(const DemOptions& options);

enum class Partner { grain, surface };  // surface: wall or tire, flat; of infinite mass, or of its area density

/// A grain and its partner, mixed for the laws.
struct MixedPair {
  const ContactMaterial &a, &b;
  double radius;          // r of the grain, m
  double reduced_radius;  // R* = r/2 or r, m
  double mass;            // m*, 1/m* = Σ 1/m, kg
  double slide_mass;      // mass with which surfaces resist sliding, kg
  double inertia;         // I*, kg m²
  double friction;        // Coulomb coefficient, -
  double rolling;         // coefficient of rolling friction, -

  /// F_c = π r² min(c_t), N.
  double cohesion_force() const;
};

/// A tire counts with its area density × 2√3 r². A damper for the grain's mass alone, whose force acts one step late,
/// would throw the lighter tire back and forth. For other grain sizes see size_scale.hpp.
/// @pre radius and mass of the grain are positive, and options.step if the law needs it
ContactCoefficients mix(const ContactMaterial& grain, const ContactMaterial& other, Partner partner,
                        const GrainProperties& properties, const DemOptions& options);

/// Mass of the grain over that of the piece of surface that its contact moves, -; 0 for a wall.
double mass_share(const GrainProperties& grain, const ContactMaterial& surface);

/// Step for a bed whose contacts have overlap `overlap`, with six neighbours per grain. @pre overlap, mass > 0
StableStep stable_step(const ContactCoefficients& pair, const GrainProperties& grain, const DemOptions& options,
                       double overlap);

/// @param index of the surface, for the message
/// @throws Error(bad_input) naming the first value for which the law's force is not finite or does not resist
void check_material(const ContactMaterial& material, LawKind law, int index);

/// Overlap as a share of the radius at which scenarios are checked: 5 % of the diameter, reached under a tire.
inline constexpr double kStatedOverlap = 0.10;

}  // namespace furrow::terrain::dem
