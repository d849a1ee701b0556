// The rut that a wheel leaves, measured on the terrain's height fields before and after.
#pragma once

#include <vector>

#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"

namespace furrow::terrain {

struct RutOptions {
  double axle = 0.0;         // x of the axle at the end, m
  double start = 0.0;        // x of the axle at the beginning, m
  double lateral = 0.0;      // y of the wheel, m
  double direction = 1.0;    // +1 travel along +x, −1 along −x
  double tread_width = 0.0;  // m
};

struct Rut {
  bool measured = false;
  double depth = 0.0;  // mean depth over the middle half of the tread width, 0.3–0.55 m behind the axle, m
  double width =
      0.0;  // distance of the points where the mean transverse profile falls below half the depth for two
            // cells or more, m; NaN when the depth is not positive
  std::vector<double> y, profile;  // mean transverse profile of (before − after) in that window, m
};

/// Not measured where there are no grains, or where the wheel has not yet left such a stretch behind.
/// @pre direction is 1 or −1
Rut measure_rut(const HeightField& before, const HeightField& after, const RutOptions& options);

}  // namespace furrow::terrain
