// Angle of repose: half of a settled bed is removed, and the rest slumps.
//
// The bed ends at walls along x and is periodic across (a slim box). All grains with x > cut that are higher than a
// base layer vanish at once, as if a wall were removed; the base layer is a rough floor. The angle is measured when the
// grains rest again: that of the flank between 15 % and 85 % of its height above the base. At this angle a flow stops;
// it is a few degrees below the angle at which a slope begins to slide. A bed with cohesion may keep its shape: the
// angle is then that of the cut, and `slumped` is false.
#pragma once

#include <vector>

#include "terrain/soil/specimen.hpp"

namespace furrow::terrain::soil {

struct ReposeTest {
  double cut = 40.0;      // where the bed is cut, radii
  double base = 4.0;      // height of the layer that stays beyond the cut, radii
  double longest = 25.0;  // longest time, in √(height/g)
  double shortest = 5.0;
};

struct ReposeResult {
  std::vector<double> x;              // m
  std::vector<double> before, after;  // surface height over x, m
  double angle = 0.0;                 // rad
  double moved = 0.0;                 // area that soil has filled beyond the cut, m²
  bool slumped = true;                // whether that area is more than 2 % of the square of the cut's height
  bool at_rest = true;                // at the end
  double time = 0.0;                  // simulated, s
  double height = 0.0;                // of the cut above the base, m
};

/// @pre the specimen is not periodic along x, and longer than the cut
/// @throws Error(physics) when a grain is lost
ReposeResult angle_of_repose(const Specimen& specimen, const ReposeTest& test, const WorkCall& work);

/// Angle (rad) of the flank of a surface that falls with x: atan of the least-squares slope between 15 % and 85 % of
/// its height above `base`, or of the steepest chord if fewer than four points are in that range.
double flank_angle(const std::vector<double>& x, const std::vector<double>& height, double base);

}  // namespace furrow::terrain::soil
