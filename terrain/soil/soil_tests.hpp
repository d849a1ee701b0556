// All soil tests on one material, and the parameters that follow from them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "terrain/soil/cone.hpp"
#include "terrain/soil/direct_shear.hpp"
#include "terrain/soil/fits.hpp"
#include "terrain/soil/plate_sinkage.hpp"
#include "terrain/soil/repose.hpp"

namespace furrow::terrain::soil {

struct SoilOptions {
  dem::DemOptions material;
  int seeds = 3;                 // beds per test: material.seed, seed + 1, …
  double speed = 0.1;            // of plate, shear and cone, m/s
  bool quick = false;            // small boxes, short paths: for a first look, not to be quoted
  int threads = 1;               // tests that run at the same time
  std::vector<double> stresses;  // of the shear tests, Pa; empty: soil_plan() chooses
  bool plate = true, shear = true, cone = true, repose = true, interface = false;
  double face_friction = -1.0;  // of the interface test, -; negative: the value among the grains
  // Plates, cones and their beds in metres; empty and 0: the sizes in grain radii.
  std::vector<double> discs, strips;  // diameters, widths, m
  std::vector<double> cones;          // diameters of the base, m
  std::vector<double> depths;         // of the beds; empty: kDepths largest plates, m
  double sinkage = 0.0;               // 0: kSinkage of the smallest plate, m
  double bed_width = 0.0;             // 0: kWidths of the largest disc, kStripWidths of the largest strip, m
  bool own_bed = false;               // use the scenario's bed for plates and cones
};
// Next to its images a strip in a bed five times as long bore 1.4 to 1.8 times as much as in one of ten
// down to 0.4 widths (scripts/docs/soils.md).
inline constexpr double kWidths = 5.0, kStripWidths = 10.0, kDepths = 3.0, kSinkage = 0.25;

/// Plates of several sizes that are pushed into a bed one after another; each starts from the bed's initial state.
struct PlateBed {
  Box box{100.0, 10.0, 40.0};
  std::vector<PlateTest> plates;
  bool exact = false;  // the bed has the depth of the box, whatever the packing
};

/// A test with a plate of this size that is pushed in by `sinkage`, m.
PlateTest plate_test(const SoilOptions& options, double size, bool disc, double sinkage);
/// A bed for these plates, `depth` m deep, as wide as the options say.
PlateBed plate_bed(const SoilOptions& options, const std::vector<PlateTest>& plates, double depth);

/// Sizes of boxes and tools in grain radii, loads in Pa.
struct SoilPlan {
  std::vector<PlateBed> plate_beds;
  Box shear_box{36.0, 16.0, 16.0};
  Box cone_box{36.0, 36.0, 36.0};
  Box repose_box{120.0, 10.0, 28.0, false, true};
  std::vector<ShearTest> shears;  // one per load
  std::vector<ShearTest> faces;   // of the interface test: by face, then load
  std::vector<ConeTest> cones;    // that of the cone index is first
  bool exact_cone_depth = false;  // as in PlateBed
  ReposeTest repose;
  double plate_from = 0.5;  // sinkage from which curves are fitted, radii
  /// Index of the deepest bed of plates, from which k_c, k_φ and n are taken.
  std::size_t deepest() const;
};
/// In radii, sizes do not depend on the grains unless they are given in metres. Shear tests have the normal stresses of
/// the options, or 20, 50 and 100 kPa, less for soft grains (at most E/200).
SoilPlan soil_plan(const SoilOptions& options);
/// Grains of the largest bed in the plan, and grain-steps of the whole plan, approximately.
struct SoilWork {
  double grains = 0.0, grain_steps = 0.0;
};
SoilWork soil_work(const SoilOptions& options, const SoilPlan& plan);

struct SpecimenFacts {
  std::uint64_t seed = 0;
  std::int64_t grains = 0;
  double length = 0.0, width = 0.0, height = 0.0;  // m
  double step = 0.0;                               // s
  double solid_fraction = 0.0;                     // volume of the grains over the volume below the surface
  double bulk_density = 0.0;                       // kg/m³
  bool settled = true;
  bool periodic_x = true, periodic_y = true;
};
template <class Result>
struct Tested {
  SpecimenFacts specimen;
  Result result;
};

struct SoilResults {
  std::vector<std::vector<Tested<PlateResult>>> plate;  // for each bed by seed, then plate
  std::vector<Tested<ShearResult>> shear;               // by seed, then load
  std::vector<Tested<ShearResult>> faces;               // by seed, then in the plan's order
  std::vector<Tested<ConeResult>> cone;                 // by seed, then size
  std::vector<Tested<ReposeResult>> repose;             // by seed
  std::vector<Tested<ReposeResult>> dry;                // the same grains without cohesion; empty if they have none
};

/// Runs the requested tests, several at a time; the results do not depend on how many.
/// @throws Error(physics) when grains fail, and what `progress` throws
SoilResults run_soil_tests(const SoilOptions& options, const SoilPlan& plan, const ProgressCall& progress);

/// Interface of grains and a face: τ = adhesion + σ tan δ, fitted to the stress at the end of the travel.
struct Interface {
  Face face{};
  Measured delta, adhesion;  // rad, Pa
  Measured delta_alone;      // rad, if there is no adhesion
  Measured K;                // m
  Measured roll, sliding;    // as in ShearResult
};

/// Shares of the displaced volume.
struct VolumeShares {
  Measured heaved, compacted, residual;
};
/// Plates of one size on one bed: p = k zⁿ, and the volume account of the soil.
struct PlateParameters {
  std::size_t bed = 0, plate = 0;  // of the plan
  Measured k, n;                   // Pa/mⁿ, -
  VolumeShares loaded, unloaded;   // no samples if the plate was not lifted
};
/// p = (k_c/b + k_φ) zⁿ of the plates on one bed.
struct BedParameters {
  Measured k_c, k_phi, n;  // errors from fits to each seed alone; no samples if all plates have one b
  double goodness = 0.0;
};
struct ConeParameters {
  Measured index, mean, gradient;  // Pa, Pa, Pa/m
};

/// The parameters; those of tests that were not run have no samples.
struct SoilParameters {
  std::vector<PlateParameters> plates;  // by bed, then plate
  std::vector<BedParameters> beds;
  Measured k_c, k_phi, n;  // of the deepest bed
  double bekker_goodness = 0.0;
  Measured cohesion, phi;  // of the fitted τ_max, Pa, rad
  Measured phi_alone;      // of the fitted τ_max if there is no cohesion, rad
  double coulomb_goodness = 0.0;
  Measured final_cohesion, final_phi;  // of the stress at the end of the travel
  Measured K;                          // mean over all shear tests, m
  std::vector<Interface> interfaces;
  Measured cone_index;                // Pa
  std::vector<ConeParameters> cones;  // by size
  Measured repose, repose_dry;        // rad
};
SoilParameters soil_parameters(const SoilResults& results, const SoilPlan& plan, double radius);

}  // namespace furrow::terrain::soil
