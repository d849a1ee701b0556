// The planar tire of the Aligator 4×4 as its file says, pressed on a plate: what the study of it needs.
#pragma once

#include <utility>
#include <vector>

#include "tire/planar/planar_static.hpp"

namespace furrow::test {

/// tire/data/aligator_planar.json
tire::PlanarParams aligator();

/// On another mesh, finer or coarser alike all over.
tire::PlanarParams meshed(tire::PlanarParams params, int around);

struct Compression {
  std::vector<std::pair<double, double>> curve;  // deflection, m, and force, N
  int elements = 0;
  /// Force at the end over deflection at the end, N/m.
  double secant() const { return curve.back().second / curve.back().first; }
  /// Slope of the straight line through the origin that fits the curve best, N/m.
  double regression() const;
};

/// On a plate, without friction, in equal steps. Fails the test where there is no equilibrium.
Compression compressed(const tire::PlanarParams& params, double deflection, int points);

}  // namespace furrow::test
