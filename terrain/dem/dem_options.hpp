// The keys of the section `terrain` with engine dem, soil made of grains. Each field has the name of its key.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "terrain/terrain_keys.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::terrain::dem {

/// The keys, and the inputs from the run.
struct DemOptions : TerrainContext {
  std::string scenario = "scenario";  // the scenario's file, for messages
  bool periodic_x = false;            // grains that leave at one end of the bin enter at the other; no end walls
  bool piece = false;                 // part of a tiled bed: its layers continue across its periodic sides, with no gap
  std::string law = "mindlin";        // mindlin | hertz_tanh
  std::string material;               // soil file whose values the other keys already have; empty: none
  double cone_index = -1.0;           // Pa; negative: not known
  // Bed.
  double radius = 0.006;                      // grain radius, m
  std::string size_distribution = "uniform";  // uniform | normal, by number of grains
  double size_spread = 0.0;                   // radii are drawn between radius (1 ± spread), -; 0: all equal
  double density = 2500.0;                    // kg/m³
  int layers = 15;                            // Poisson-disk layers dropped
  double length = 10.0;                       // bin, x from 0 to length, m
  double width = 0.6;                         // bin, y from −width/2 to width/2, m
  std::string sides = "walls";                // walls | periodic: of the bin, at y = ±width/2
  std::string bed;  // file: a settled bed (HDF5), or positions to settle (CSV x_m,y_m,z_m); empty: generate
  std::string bed_generator = "poisson";  // poisson | lattice: initial positions of the grains of a new bed
  double tile = 0.0;  // length and width of the settled pieces that make up a new bed, about, m; 0: one piece
  double undisturbed_height = -1.0;  // of the surface from which sinkage counts, m; negative: the bed's own mean
  double settling_friction = -1.0;   // friction while a new bed falls and is pressed, -; negative: friction
  double settling_cohesion = -1.0;   // cohesion while a new bed falls and is pressed, Pa; negative: cohesion
  double settling_drag = -1.0;       // drag while a new bed falls, √(g/radius); negative: 4 1/s
  double solid_fraction = -1.0;      // of the middle of a new bed, -; negative: not prescribed
  double bulk_density = -1.0;        // kg/m³, determines density; negative: not prescribed
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
  std::string device = "cpu";            // that steps the grains: cpu | gpu

  bool periodic_y() const { return sides == "periodic"; }
  bool on_gpu() const { return device == "gpu"; }
};

/// Messages list the keys that a soil file may have in the order of those with role::soil.
void visit_fields(FieldsOf<DemOptions> auto& s, auto&& visit) {
  using namespace allowed;
  constexpr unsigned kBed = role::key | role::bed, kSoil = role::key | role::soil, kBoth = kBed | kSoil;
  visit(s.law,
        key("law", "", kBoth, words("mindlin hertz_tanh"),
            "Contact law. mindlin: Hertz–Mindlin with history. hertz_tanh: Hertz with friction regularised by tanh, as "
            "in Project Chrono, which has no static friction."));
  visit(s.material, keys::kMaterial);
  visit(s.cone_index, keys::kConeIndex);
  visit(s.radius,
        key("radius", "m", kBed, from(1e-6).below(1).usual(0.0005, 0.05),
            "Grain radius; with size_spread the middle of the radii, which is their mean and median by number."));
  visit(s.density, key("density", "kg/m³", kBoth, from(1, 1e5).usual(500, 12000), "Density of a grain."));
  visit(s.young_modulus, key("young_modulus", "Pa", kBoth, from(1, 1e13).usual(1e5, 1e11),
                             "Young's modulus of the grains, law mindlin."));
  visit(s.poisson_ratio,
        key("poisson_ratio", "-", kBoth, above(-1).to(0.5), "Poisson's ratio of the grains, law mindlin."));
  visit(s.restitution, key("restitution", "-", kBoth, from(0, 1),
                           "Coefficient of restitution of two grains in a central impact, law mindlin."));
  visit(s.friction, keys::kFriction.with(kBoth));
  visit(s.cohesion,
        key("cohesion", "Pa", kBoth, from(0, 1e9).usual(100, 1e6),
            "Cohesion c_t of contacts: grains that touch attract each other by π r² c_t. It is not the cohesion c of "
            "soil mechanics, which `furrow soil` measures."));
  visit(s.size_distribution,
        key("size_distribution", "", kBoth, words("uniform normal"),
            "Distribution of the radii within size_spread: uniform, or normal with a standard deviation of half the "
            "spread, cut at its ends."));
  visit(s.size_spread,
        key("size_spread", "-", kBoth, from(0, 0.6),
            "Spread of the radii: they are drawn from radius × (1 − spread) to radius × (1 + spread), law mindlin. 0: "
            "all grains are alike."));
  visit(s.bed_generator,
        key("bed_generator", "", kBoth, words("poisson lattice"),
            "How the grains of a layer are placed before they fall. poisson: at random, with a least distance of 2.02 "
            "r. lattice: on squares 2.3 r wide, jittered by 0.14 r, every other layer shifted by half a spacing; 20 % "
            "more grains per layer."));
  visit(s.rolling_friction,
        key("rolling_friction", "-", kBoth, from(0, 10),
            "Coefficient of rolling friction: limit of the rolling resistance torque over normal force × effective "
            "radius, law mindlin."));
  visit(s.settling_friction,
        key("settling_friction", "-", kBoth, from(0, 10).or_null(),
            "Coulomb coefficient between grains while a new bed falls and is pressed; rolling resistance is scaled "
            "likewise. Lower packs denser, higher looser. The bed then settles once more with friction. null: "
            "friction."));
  visit(s.settling_cohesion,
        key("settling_cohesion", "Pa", kBoth, from(0, 1e9).or_null(),
            "Cohesion of contacts while a new bed falls and is pressed; the bed then settles on with cohesion. Lower "
            "packs denser. null: cohesion."));
  visit(s.settling_drag,
        key("settling_drag", "-", kBoth, from(0, 100).or_null(),
            "Drag on grains while a new bed falls, in √(g/radius): they come down at √(g radius)/settling_drag. Slower "
            "grains lie looser; beyond 2 it hardly matters. null: 4 1/s, whatever the radius."));
  visit(
      s.solid_fraction,
      key("solid_fraction", "-", kBoth, from(0.3, 0.74).usual(0.45, 0.65).or_null(),
          "Solid fraction asked for: volume of the grains over that of the bed in its middle (half of its depth, away "
          "from walls). The bed is made anew until it has it within 0.003 (0.006 below 0.52, where beds are "
          "metastable), with settling_friction and settling_drag of its own, or with those that are given if they "
          "do. A settled bed from a file is compared with it. null: what comes of it."));
  visit(s.bulk_density,
        key("bulk_density", "kg/m³", role::key | role::soil, from(1, 1e5).usual(300, 8000).or_null(),
            "Density of the bed as a whole: density becomes bulk_density / solid_fraction, which must be given. null: "
            "what density and packing make."));
  visit(s.compaction_pressure,
        key("compaction_pressure", "Pa", kBoth, from(0, 1e9).usual(1e3, 1e6),
            "Pressure of a flat frictionless lid that presses the settled bed and is lifted again before use. 0: no "
            "lid."));
  visit(s.layers, key("layers", "", kBed, from(1, 9999).usual(1, 200),
                      "Poisson-disk layers of grains dropped into the bin. The bed's depth is roughly 1.3 r per layer "
                      "of equal grains, "
                      "0.7 to 0.8 r with a size_spread of 0.3."));
  visit(s.length, keys::kLength.with(kBed));
  visit(s.width, keys::kWidth.with(kBed));
  visit(s.sides,
        key("sides", "", kBed, words("walls periodic"),
            "Sides of the bin at y = ±width/2. walls: two walls. periodic: grains that leave at one side come back at "
            "the other, as on ground without an end; a tire must fit between the sides."));
  visit(s.tile,
        key("tile", "m", kBed, from(0, 1e4).usual(0.4, 20),
            "Length and width of the pieces that a large new bed is put together of, at least 40 r; beds from a file "
            "have none. One piece is settled and copied. The copies are shifted and turned so that a tire does not "
            "soon meet the same grains again. Then the seams settle. 0: the bed settles as a whole."));
  visit(s.normal_stiffness, key("normal_stiffness", "N/m^1.5", kBed, from(1, 1e13).usual(1e4, 1e10),
                                "Normal stiffness k_n of two grains, law hertz_tanh."));
  visit(s.normal_damping,
        key("normal_damping", "N s/m^1.5", kBed, from(0, 1e9), "Normal damping g_n of two grains, law hertz_tanh."));
  visit(s.friction_velocity_scale, keys::kFrictionVelocityScale.with(kBed));
  visit(s.precision,
        key("precision", "", kBed, words("mixed double"),
            "Precision of the contact law between grains, engine dem. mixed: the law in single precision; positions, "
            "sums of forces and motion in double. double: all in double, half as fast."));
  visit(s.device,
        key("device", "", kBed, words("cpu gpu"),
            "Device that steps the grains, engine dem. gpu: an NVIDIA GPU, where the program has the library for it. "
            "There no grain sleeps, precision is mixed and size_spread 0."));
  visit(s.friction_impulse_limit,
        key("friction_impulse_limit", "",
            "Limit friction so that one step cannot reverse a sliding grain, law hertz_tanh. false reproduces the 2016 "
            "report."));
  visit(s.bed,
        key("bed", "", not_empty().or_null(),
            "File with a bed to start from, relative to the scenario. A settled bed of furrow (.h5) is used unchanged. "
            "Positions are settled first: a CSV file with the header x_m,y_m,z_m or x_m,y_m,z_m,radius_m, in metres, x "
            "from 0 to length and y from −width/2 to width/2; or an HDF5 file with a dataset position, N × 3, and "
            "perhaps radius, as frames of grains have. No grain may be more than 100 radii above the next one below it "
            "or the floor. null: generate a bed, or take it from the cache."));
  visit(s.undisturbed_height,
        key("undisturbed_height", "m", from(0, 1e3).or_null(),
            "Height of the surface from which sinkage counts, for a bed that a tire has driven over. null: the mean "
            "height of the bed at the start of the run."));
  visit(s.activity,
        key("activity", "",
            "Let parcels of grains that rest far from the tire sleep until something moves them, engine dem. It needs "
            "static friction, so law hertz_tanh without friction_impulse_limit ignores it."));
  visit(s.allow_unstable_step,
        key("allow_unstable_step", "",
            "Warn instead of refusing when run.step is above the stable one. It is meant for the `_tr` scenarios."));
  visit(s.cache, key("cache", "", role::harmless, "Keep settled beds under ~/.cache/furrow/beds and use them again."));
}

/// The same keys with the inputs of another run.
inline DemOptions with_context(DemOptions options, const TerrainContext& context) {
  static_cast<TerrainContext&>(options) = context;
  return options;
}

}  // namespace furrow::terrain::dem
