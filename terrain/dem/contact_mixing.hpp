// From materials to the coefficients of a contact, and the step that a bed of such contacts allows.
#pragma once

#include <string>

#include "protocol/core/surface.hpp"
#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

enum class LawKind { mindlin, hertz_tanh };
/// `coulomb`, as hertz_tanh was called before, is accepted. @throws Error(bad_input) listing the valid names.
LawKind law_from(const std::string& name);
/// The name by which digests and files know the law.
const char* law_name(LawKind law);

/// A grain.
struct GrainProperties {
  double radius = 0.0;   // m
  double mass = 0.0;     // kg
  double inertia = 0.0;  // 2/5 m r², kg m²
};
GrainProperties grain_properties(double radius, double density);

/// The grains' own material as options state it.
ContactMaterial grain_material(const DemOptions& options);

/// What a law needs beyond the two materials.
struct LawSettings {
  LawKind kind = LawKind::mindlin;
  double rolling_friction = 0.0;  // μ_r of the grains, against every partner, -
  double velocity_scale = 5.0;    // c, s/m
  bool friction_impulse_limit = true;
  double step = 0.0;  // s, for the impulse limit
};
LawSettings law_settings(const DemOptions& options);

enum class Partner { grain, surface };  // surface: wall or tire, flat; of infinite mass, or of its area density

/// Mixing: k_n, g_n arithmetic mean; μ, e, c_t minimum; 1/E* = Σ(1−ν²)/E, 1/G* = Σ 2(2−ν)(1+ν)/E; R* = r/2 or r;
/// 1/m* = Σ 1/m, of a tire its area density × 2√3 r²: a damper made for the grain's mass alone would, felt one step
/// late, throw the lighter tire back and forth. Cohesion area π r² of the grain. For other sizes see size_scale.hpp.
/// @pre radius and mass of the grain are positive; with the impulse limit of law coulomb law.step > 0
ContactCoefficients mix(const ContactMaterial& grain, const ContactMaterial& other, Partner partner,
                        const GrainProperties& properties, const LawSettings& law);

/// Mass of the grain over that of the piece of surface its contact moves, -; 0 for a wall.
double mass_share(const GrainProperties& grain, const ContactMaterial& surface);

/// Largest stable step of semi-implicit Euler and what limits it.
struct StableStep {
  double step = 0.0;   // s
  std::string reason;  // "stiffness", "damping", "friction viscosity"
};
/// For a bed whose contacts have overlap `overlap` and six neighbours per grain. @pre overlap, stiffness, mass > 0
StableStep stable_step(const ContactCoefficients& pair, const GrainProperties& grain, const LawSettings& law,
                       double overlap);

/// Overlap as a share of the radius at which scenarios are checked: 5 % of the diameter, reached under a tire.
inline constexpr double kStatedOverlap = 0.10;

/// β of the impulse limit, Eq. (6) of contact_law.hpp.
inline constexpr double kImpulseShare = 0.3;

}  // namespace furrow::terrain::dem
