// Direct shear between two toothed plates: the lower one at rest, the upper one a lid under a constant load that is
// moved along x at constant speed and rises and falls freely.
//
// The cell is periodic along and across: an annular shear cell cut open. It has neither side walls that carry load nor
// an area that changes with travel, and all of its height shears, so K belongs to the stated height. Shear stress
// positive against the motion, travel j positive along it, normal stress positive in compression; both stresses are
// those on the lid.
#pragma once

#include <vector>

#include "terrain/soil/fits.hpp"
#include "terrain/soil/specimen.hpp"

namespace furrow::terrain::soil {

/// What the upper plate turns to the grains: teeth, so that the soil shears, or a face that they may slide and roll
/// along, flat or with half-grains glued to it.
enum class Face { teeth, flat, glued };

struct ShearTest {
  double normal_stress = 50e3;  // Pa
  double travel = 8.0;          // radii
  double speed = 0.1;           // m/s
  double pitch = 6.0;           // of the teeth, radii; the cell's length is a multiple
  double tooth = 1.5;           // their height, radii
  int samples = 200;
  Face face = Face::teeth;
  double friction = -1.0;  // between grains and a face without teeth, -; negative: as among grains
};

struct ShearResult {
  Face face = Face::teeth;
  double normal_nominal = 0.0;        // Pa
  std::vector<double> travel;         // j, m
  std::vector<double> shear, normal;  // Pa, means over each sample's interval
  std::vector<double> rise;           // of the lid since shearing began, m: dilation positive
  double height = 0.0;                // between the plates' flats when shearing began, m
  double normal_mean = 0.0;           // over the second half, Pa
  double final_shear = 0.0;           // mean over the last quarter, Pa
  JanosiFit janosi;
  // Of the grains at a face without teeth, means over the second half.
  double roll = 0.0;  // Σ ω r / Σ v, v the plate's speed against the centre: 1 where they roll, 0 where they slide
  double sliding = 0.0;  // share of the plate's contacts that are at the limit of friction
  double solid = 0.0;    // solid fraction within 4 r of the face
  double floor_error =
      0.0;  // |force on the lower plate and floor − weight − lid force| / that, mean of the second half
  double shear_error = 0.0;  // |shear force on lower + on upper plate| / upper, mean of the second half
};

const char* face_name(Face face);

/// @throws Error(physics) when the grains fail
ShearResult direct_shear(const Specimen& specimen, const ShearTest& test, const WorkCall& work);

}  // namespace furrow::terrain::soil
