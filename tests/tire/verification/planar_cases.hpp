// The planar tire of the Aligator 4×4 from its file, pressed on a plate, for its study.
#pragma once

#include <utility>
#include <vector>

#include "tire/planar/planar_static.hpp"

namespace furrow::test {

/// tire/data/aligator_planar.json
tire::PlanarParams aligator();

/// The tire with a mesh that is uniformly finer or coarser.
tire::PlanarParams meshed(tire::PlanarParams params, int around);

struct Compression {
  std::vector<std::pair<double, double>> curve;  // deflection, m, and force, N
  int elements = 0;
  /// Force at the end over deflection at the end, N/m.
  double secant() const { return curve.back().second / curve.back().first; }
  /// Slope of the straight line through the origin that fits the curve best, N/m.
  double regression() const;
};

/// Presses the tire on a plate, without friction, in equal steps. Fails the test if there is no equilibrium.
Compression compressed(const tire::PlanarParams& params, double deflection, int points);

}  // namespace furrow::test
