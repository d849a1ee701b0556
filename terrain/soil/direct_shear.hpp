// Direct shear between two toothed plates. The lower plate is at rest. The upper plate, a lid under a constant load,
// moves along x at constant speed and rises and falls freely.
//
// The cell is periodic along and across, like an annular shear cell cut open. It has no side walls that carry load, and
// its area does not change with travel. All of its height shears, so K belongs to the stated height. Both stresses are
// on the lid: shear stress is positive against the motion, normal stress in compression; travel j is positive along it.
#pragma once

#include <vector>

#include "terrain/soil/fits.hpp"
#include "terrain/soil/specimen.hpp"

namespace furrow::terrain::soil {

/// Face of the upper plate towards the grains. Teeth shear the soil. Along a face without teeth, which is flat or has
/// half-grains glued to it, the grains may slide and roll.
enum class Face { teeth, flat, glued };

struct ShearTest {
  double normal_stress = 50e3;  // Pa
  double travel = 8.0;          // radii
  double speed = 0.1;           // m/s
  double pitch = 6.0;           // of the teeth, radii; the cell's length is a multiple
  double tooth = 1.5;           // their height, radii
  int samples = 200;
  Face face = Face::teeth;
  double friction = -1.0;  // between grains and a face without teeth, -; negative: the value among grains
};

struct ShearResult {
  Face face = Face::teeth;
  double normal_nominal = 0.0;        // Pa
  std::vector<double> travel;         // j, m
  std::vector<double> shear, normal;  // Pa, means over each sample's interval
  std::vector<double> rise;           // of the lid since shearing began, m; positive for dilation
  double height = 0.0;                // distance of the plates' flats when shearing began, m
  double normal_mean = 0.0;           // over the second half, Pa
  double final_shear = 0.0;           // mean over the last quarter, Pa
  JanosiFit janosi;
  // Of the grains at a face without teeth; means over the second half.
  double roll = 0.0;     // Σ ω r / Σ v, v the plate's speed against the centre: 1 for rolling, 0 for sliding
  double sliding = 0.0;  // share of the plate's contacts at the limit of friction
  double solid = 0.0;    // solid fraction within 4 r of the face
  double floor_error =
      0.0;  // |force on the lower plate and floor − weight − lid force| / lid force, mean of the second half
  double shear_error = 0.0;  // |shear force on lower + on upper plate| / upper, mean of the second half
};

const char* face_name(Face face);

/// @throws Error(physics) when the grains fail
ShearResult direct_shear(const Specimen& specimen, const ShearTest& test, const WorkCall& work);

}  // namespace furrow::terrain::soil
