// What a scenario says about its terrain; every field is the scenario key `terrain.<name>`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "terrain/terrain.hpp"

namespace furrow::terrain {

struct TerrainOptions {
  std::string scenario = "scenario";  // what messages name: the scenario's file
  std::string engine = "dem";         // dem | rigid
  std::string law = "mindlin";        // mindlin | hertz_tanh
  // Bed.
  double radius = 0.006;                      // grain radius, m
  std::string size_distribution = "uniform";  // uniform | normal, by number of grains
  double size_spread = 0.0;                   // radii are drawn between radius (1 ± spread), -; 0: all alike
  double density = 2500.0;                    // kg/m³
  int layers = 15;                            // Poisson-disk layers dropped
  double length = 10.0;                       // bin, x from 0 to length, m
  double width = 0.6;                         // bin, y from −width/2 to width/2, m
  bool periodic_x = false;  // grains that leave at one end of the bin come back at the other; no end walls
  bool periodic_y = false;  // the same across; no side walls (terrain.sides)
  std::uint64_t seed = 1;   // run.seed
  std::string bed;  // file: a settled bed (HDF5), or positions to settle (CSV x_m,y_m,z_m); empty: generate
  std::string bed_generator = "poisson";  // poisson | lattice: where the grains of a new bed start
  double undisturbed_height =
      -1.0;  // of the surface that sinkage counts from, m; negative: the bed's own mean
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
  double friction_velocity_scale = 5.0;  // c in F_t = μ F_e tanh(c |v_t|), s/m, hertz_tanh, rigid ground
  bool friction_impulse_limit = true;    // law hertz_tanh: caps F_t at β m_t |v_t| / dt
  bool activity = true;                  // let resting grains sleep
  std::string precision =
      "mixed";  // of the contact law between grains: mixed (single, sums in double) | double
  // Rigid ground (engine rigid): a stiff elastic layer, pressure = stiffness × depth + damping × its rate.
  double ground_stiffness = 4e8;  // N/m³: 0.6 mm under 240 kPa; 4e5 N/m on a vertex that carries 10 cm²
  double ground_shear_stiffness = 1e8;  // N/m³: a tread of 1 MPa shear modulus, 10 mm thick
  double ground_damping = 2.5e4;        // N s/m³: holds such a vertex of 2.8 g by itself up to H = 4e-5 s
  // Coupling.
  bool contact_tangents = false;  // tire.contact_tangent of any tire: send them beside the forces
  // Stepping.
  double step = 4e-5;  // run.step / terrain.substeps, s: the step the engine will be advanced with
  bool allow_unstable_step = false;  // *_tr scenarios: warn instead of refusing
  int threads = 1;                   // OpenMP threads while stepping
  int settle_threads = 1;            // OpenMP threads while settling
};

/// Makes the engine that `options.engine` names.
/// @throws Error(bad_input) listing the valid names.
std::unique_ptr<Terrain> make_terrain(const TerrainOptions& options);

/// What `furrow validate` says of a terrain before any grain exists.
struct TerrainEstimate {
  double stable_step = 0.0;   // s
  std::string stable_reason;  // "stiffness", "damping", "friction viscosity"
  std::int64_t grains = 0;
  double memory_bytes = 0.0;
  double expected_height = 0.0;  // m
};
TerrainEstimate estimate_terrain(const TerrainOptions& options);

}  // namespace furrow::terrain
