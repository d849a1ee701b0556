// Plate sinkage test (bevameter): a rough, rigid strip pushed into the soil at constant speed.
//
// The strip spans a bed that is periodic along and across: plane strain, no walls near. Sinkage z counts from the mean
// undisturbed surface, pressure p is the vertical force over width × length of the strip, positive in compression.
#pragma once

#include "terrain/soil/fits.hpp"
#include "terrain/soil/specimen.hpp"

namespace furrow::terrain::soil {

struct PlateTest {
  double width = 10.0;   // b, radii
  double sinkage = 8.0;  // to which it is pushed, radii
  double speed = 0.1;    // m/s
  int samples = 200;     // of the curve
};

struct PlateResult {
  PlateCurve curve;            // means over each sample's interval
  double balance_error = 0.0;  // |floor force − weight − plate force| / plate force, mean over the second half
};

/// @throws Error(physics) when the grains fail
PlateResult plate_sinkage(const Specimen& specimen, const PlateTest& test, const WorkCall& work);

}  // namespace furrow::terrain::soil
