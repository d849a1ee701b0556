// Cone penetration: a 30° cone of polished steel on a thinner shaft, pushed in at constant speed.
//
// Like the cone penetrometer of ASABE S313.3 (30° cone, shaft 0.78 of its base diameter), but the base diameter is
// given in grain radii instead of 20.27 mm, and the speed may differ from 30 mm/s. Pressure q = vertical force / base
// area; depth counts from the mean undisturbed surface to the cone's base.
#pragma once

#include <vector>

#include "terrain/soil/specimen.hpp"

namespace furrow::terrain::soil {

inline constexpr double kConeAngle = 0.523598775598298873;  // total, rad: 30°
inline constexpr double kConeShaft = 15.88 / 20.27;         // of the base diameter

struct ConeTest {
  double diameter = 6.0;    // of the base, radii
  double depth = 9.0;       // final depth of the base, radii
  double index_from = 6.0;  // the index is the mean between these depths, radii
  double index_to = 9.0;
  double speed = 0.1;  // m/s
  int samples = 200;
};

struct ConeResult {
  std::vector<double> depth;     // of the base, m; negative until the cone is fully in
  std::vector<double> pressure;  // Pa
  double index = 0.0;            // cone index, Pa
  // Over all depths of the base from 0 on.
  double mean = 0.0;      // Pa
  double gradient = 0.0;  // of a line fitted to the pressure over the depth, Pa/m
  double reached = 0.0;   // last of these depths, m: the test's, or that with the point a diameter above the floor
};

/// @throws Error(physics) when the grains fail, Error(bad_input) when the bed is too shallow for the cone
ConeResult cone_penetration(const Specimen& specimen, const ConeTest& test, const WorkCall& work);

}  // namespace furrow::terrain::soil
