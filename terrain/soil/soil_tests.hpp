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
  bool quick = false;            // small boxes, short ways: a look, no result to quote
  int threads = 1;               // tests that run at the same time
  std::vector<double> stresses;  // of the shear tests, Pa; empty: soil_plan() chooses
  bool plate = true, shear = true, cone = true, repose = true, interface = false;
  double face_friction = -1.0;  // of the interface test, -; negative: as among the grains
};

/// Sizes of boxes and tools in grain radii, of the loads in Pa.
struct SoilPlan {
  Box plate_box{100.0, 10.0, 40.0};
  Box shear_box{36.0, 16.0, 16.0};
  Box cone_box{36.0, 36.0, 36.0};
  Box repose_box{120.0, 10.0, 28.0, false, true};
  std::vector<PlateTest> plates;  // two widths
  std::vector<ShearTest> shears;  // three loads
  std::vector<ShearTest> faces;   // of the interface test: by face, then load
  ConeTest cone;
  ReposeTest repose;
  double plate_from = 0.5;  // sinkage from which Bekker's curve is fitted, radii
};
/// Sizes do not depend on the grains; normal stresses are the ones asked for, or 20, 50 and 100 kPa, less for soft
/// grains (at most E/200).
SoilPlan soil_plan(const SoilOptions& options);

struct SpecimenFacts {
  std::uint64_t seed = 0;
  std::int64_t grains = 0;
  double length = 0.0, width = 0.0, height = 0.0;  // m
  double step = 0.0;                               // s
  double solid_fraction = 0.0;                     // volume of the grains over that below the surface
  double bulk_density = 0.0;                       // kg/m³
  bool settled = true;
};
template <class Result>
struct Tested {
  SpecimenFacts specimen;
  Result result;
};

struct SoilResults {
  std::vector<Tested<PlateResult>> plate;    // by seed, then width
  std::vector<Tested<ShearResult>> shear;    // by seed, then load
  std::vector<Tested<ShearResult>> faces;    // by seed, then as the plan's
  std::vector<Tested<ConeResult>> cone;      // by seed
  std::vector<Tested<ReposeResult>> repose;  // by seed
  std::vector<Tested<ReposeResult>> dry;     // the same grains without cohesion; empty where they have none
};

/// Runs the tests that are asked for, several at a time; the results do not depend on how many.
/// @throws Error(physics) when grains fail, and what `progress` throws
SoilResults run_soil_tests(const SoilOptions& options, const SoilPlan& plan, const ProgressCall& progress);

/// Grains against a face: τ = adhesion + σ tan δ of the stress at the end of the travel.
struct Interface {
  Face face{};
  Measured delta, adhesion;  // rad, Pa
  Measured delta_alone;      // rad, if there is no adhesion
  Measured K;                // m
  Measured roll, sliding;    // as of ShearResult
};

/// The parameters; those of tests that were not run have no samples.
struct SoilParameters {
  Measured k_c, k_phi, n;  // errors from fits of each seed alone
  double bekker_goodness = 0.0;
  Measured cohesion, phi;  // of the fitted τ_max, Pa, rad
  Measured phi_alone;      // of the fitted τ_max if there is no cohesion, rad
  double coulomb_goodness = 0.0;
  Measured final_cohesion, final_phi;  // of the stress at the end of the travel
  Measured K;                          // mean over all shear tests, m
  std::vector<Interface> interfaces;
  Measured cone_index;          // Pa
  Measured repose, repose_dry;  // rad
};
SoilParameters soil_parameters(const SoilResults& results, const SoilPlan& plan, double radius);

}  // namespace furrow::terrain::soil
