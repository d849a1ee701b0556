// The rut that a wheel leaves, measured on the terrain's height fields before and after.
#pragma once

#include <string>
#include <vector>

#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"

namespace furrow::terrain {

struct RutOptions {
  double axle = 0.0;         // x of the axle at the end, m
  double start = 0.0;        // x of the axle at the beginning, m
  double lateral = 0.0;      // y of the wheel, m
  double direction = 1.0;    // +1 travel along +x, −1 along −x
  double radius = 0.0;       // of the undeformed tire, m
  double tread_width = 0.0;  // m
};

struct Rut {
  bool measured = false;
  std::string missing;  // why depth or width is missing, in words
  double depth = 0.0;   // mean depth over the middle half of the tread width, 0.642 to 1.177 R behind the axle, m
  double width = 0.0;   // distance of the points where the mean transverse profile falls below half the depth for two
                        // cells or more, m; NaN when the depth is not positive
  std::vector<double> y, profile;  // mean transverse profile of (before − after) behind the axle, as for the depth, m
  std::vector<double> along;       // depth of each row of cells across, in order along x, m; empty rows are left out
};

/// The measured stretch corresponds to that of the reference wheel, 0.30 to 0.55 m at R = 0.4673 m. It begins behind
/// the contact of a wheel that has sunk by a fifth of its radius (√(2 z R) = 0.63 R). The rut is not measured where
/// there are no grains, or before the wheel has travelled that far.
/// @pre direction is 1 or −1; radius > 0
Rut measure_rut(const HeightField& before, const HeightField& after, const RutOptions& options);

}  // namespace furrow::terrain
