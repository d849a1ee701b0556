// The keys of the section `terrain` with engine dem, soil made of grains: each field is the key of its name.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain::dem {

/// The keys, and what the run supplies.
struct DemOptions : TerrainContext {
  std::string scenario = "scenario";  // what messages name: the scenario's file
  bool periodic_x = false;            // grains that leave at one end of the bin come back at the other; no end walls
  bool piece = false;                 // of a tiled bed: its layers continue across its periodic sides, with no gap
  std::string law = "mindlin";        // mindlin | hertz_tanh
  std::string material;               // soil file whose values the other keys hold already; empty: none
  // Bed.
  double radius = 0.006;                      // grain radius, m
  std::string size_distribution = "uniform";  // uniform | normal, by number of grains
  double size_spread = 0.0;                   // radii are drawn between radius (1 ± spread), -; 0: all alike
  double density = 2500.0;                    // kg/m³
  int layers = 15;                            // Poisson-disk layers dropped
  double length = 10.0;                       // bin, x from 0 to length, m
  double width = 0.6;                         // bin, y from −width/2 to width/2, m
  std::string sides = "walls";                // walls | periodic: of the bin, at y = ±width/2
  std::string bed;  // file: a settled bed (HDF5), or positions to settle (CSV x_m,y_m,z_m); empty: generate
  std::string bed_generator = "poisson";  // poisson | lattice: where the grains of a new bed start
  double tile = 0.0;  // a new bed is put together of settled pieces about this long and wide, m; 0: of one
  double undisturbed_height = -1.0;  // of the surface that sinkage counts from, m; negative: the bed's own mean
  double settling_friction = -1.0;   // friction while a new bed falls and is pressed, -; negative: friction
  double compaction_pressure = 0.0;  // a lid pressed on the settled bed and lifted again, Pa; 0: none
  bool cache = true;                 // keep settled beds under the user's cache directory
  // Contact between grains and of grains with walls.
  double young_modulus = 2.49e7;         // Pa, law mindlin
  double poisson_ratio = 0.3;            // -
  double restitution = 0.2;              // -, law mindlin
  double friction = 0.9;                 // -
  double rolling_friction = 0.0;         // -, rolling resistance torque / (normal force × effective radius)
  double cohesion = 0.0;                 // c_t, Pa: F_c = π r² c_t
  double normal_stiffness = 1e6;         // k_n, N/m^1.5, law hertz_tanh
  double normal_damping = 60.0;          // g_n, N s/m^1.5, law hertz_tanh
  double friction_velocity_scale = 5.0;  // c in F_t = μ F_e tanh(c |v_t|), s/m, law hertz_tanh
  bool friction_impulse_limit = true;    // law hertz_tanh: caps F_t at β m_t |v_t| / dt
  bool activity = true;                  // let resting grains sleep
  std::string precision = "mixed";       // of the contact law between grains: mixed (single, sums in double) | double
  bool allow_unstable_step = false;      // *_tr scenarios: warn instead of refusing

  bool periodic_y() const { return sides == "periodic"; }
};

/// The order of those with role::soil is the order in which messages list what a soil file may say.
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DemOptions> auto& s) {
  constexpr unsigned kBed = role::key | role::bed, kSoil = role::key | role::soil, kBoth = kBed | kSoil;
  visit(Field{"law", "", kBoth}, s.law);
  visit(Field{"material", "", role::key}, s.material);
  visit(Field{"radius", "m", kBed}, s.radius);
  visit(Field{"density", "kg/m³", kBoth}, s.density);
  visit(Field{"young_modulus", "Pa", kBoth}, s.young_modulus);
  visit(Field{"poisson_ratio", "-", kBoth}, s.poisson_ratio);
  visit(Field{"restitution", "-", kBoth}, s.restitution);
  visit(Field{"friction", "-", kBoth}, s.friction);
  visit(Field{"cohesion", "Pa", kBoth}, s.cohesion);
  visit(Field{"size_distribution", "", kBoth}, s.size_distribution);
  visit(Field{"size_spread", "-", kBoth}, s.size_spread);
  visit(Field{"bed_generator", "", kBoth}, s.bed_generator);
  visit(Field{"rolling_friction", "-", kBoth}, s.rolling_friction);
  visit(Field{"settling_friction", "-", kBoth}, s.settling_friction);
  visit(Field{"compaction_pressure", "Pa", kBoth}, s.compaction_pressure);
  visit(Field{"layers", "-", kBed}, s.layers);
  visit(Field{"length", "m", kBed}, s.length);
  visit(Field{"width", "m", kBed}, s.width);
  visit(Field{"sides", "", kBed}, s.sides);
  visit(Field{"tile", "m", kBed}, s.tile);
  visit(Field{"normal_stiffness", "N/m^1.5", kBed}, s.normal_stiffness);
  visit(Field{"normal_damping", "N s/m^1.5", kBed}, s.normal_damping);
  visit(Field{"friction_velocity_scale", "s/m", kBed}, s.friction_velocity_scale);
  visit(Field{"precision", "", kBed}, s.precision);
  visit(Field{"friction_impulse_limit", "", role::key}, s.friction_impulse_limit);
  visit(Field{"bed", "", role::key}, s.bed);
  visit(Field{"undisturbed_height", "m", role::key}, s.undisturbed_height);
  visit(Field{"activity", "", role::key}, s.activity);
  visit(Field{"allow_unstable_step", "", role::key}, s.allow_unstable_step);
  visit(Field{"cache", "", role::key | role::harmless}, s.cache);
}

/// The same keys in another run.
inline DemOptions with_context(DemOptions options, const TerrainContext& context) {
  static_cast<TerrainContext&>(options) = context;
  return options;
}

}  // namespace furrow::terrain::dem
