// Distance of the shell from the rim that holds it. The rim is a solid cylinder of the beads' radius between the bead
// loops. Beyond its flanges, the shell may come nearer to the axle. Rim and shell have no contact law: a tire without
// clearance is outside this model's range.
#pragma once

#include <vector>

#include "tire/ancf/shell_layout.hpp"
#include "tire/shell_mesh.hpp"
#include "tire/tire.hpp"

namespace furrow::tire {

class RimClearance {
 public:
  RimClearance(const TireFile& file, const ShellMesh& mesh);

  /// The node between the beads whose inner surface is nearest to the rim, and the one farthest from the axle's centre.
  struct Nodes {
    double clearance = 1e300;  // m, negative: inside the rim; huge when no node is over the rim
    int column = 0, row = 0;   // of the nearest
    double farthest = 0.0;     // m
    int far_column = 0, far_row = 0;
  };
  Nodes measure(const ShellLayout& layout, const Field& q, const RimState& rim) const;

  /// Failure if these nodes are too near or too far, with figures and advice.
  Outcome outcome(const Nodes& nodes) const;

 private:
  double radius_ = 0.0, half_width_ = 0.0;  // of the cylinder, m
  double limit_ = 0.0;                      // of the distance from the axle's centre, m
  std::vector<double> inside_;              // of the mid-surface, by row: half the thickness, m
};

}  // namespace furrow::tire
