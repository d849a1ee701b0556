// Plate sinkage test (bevameter): a rough, rigid strip or disc pushed into the soil at constant speed.
//
// The strip spans a bed that is periodic along and across: plane strain, without walls nearby. Sinkage z counts from
// the mean undisturbed surface; for a disc, from the mean within a diameter of its middle along both axes. Pressure p
// is the vertical force over the area of the plate, positive in compression.
#pragma once

#include "terrain/soil/fits.hpp"
#include "terrain/soil/specimen.hpp"
#include "terrain/soil/volume_account.hpp"

namespace furrow::terrain::soil {

struct PlateTest {
  double width = 10.0;   // of the strip, or diameter of the disc, radii
  double sinkage = 8.0;  // final sinkage, radii
  double speed = 0.1;    // m/s
  int samples = 200;     // of the curve
  bool disc = false;     // instead of a strip
  bool unload = false;   // lift the plate at the end until it bears nothing, and repeat the volume account
};

struct PlateResult {
  PlateCurve curve;            // means over each sample's interval; b of a disc is its radius [Wong 2008]
  double balance_error = 0.0;  // |floor force − weight − plate force| / plate force, mean over the second half; NaN
                               // if there are walls
  bool disc = false;
  double size = 0.0;       // width of the strip, diameter of the disc, m
  VolumeAccount volume;    // at the end, under the load; elastic compression counts as compaction
  VolumeAccount unloaded;  // without the load, if PlateTest::unload
  double rebound = 0.0;    // by which the plate was then lifted, m
};

/// @throws Error(physics) when the grains fail
PlateResult plate_sinkage(const Specimen& specimen, const PlateTest& test, const WorkCall& work);

}  // namespace furrow::terrain::soil
