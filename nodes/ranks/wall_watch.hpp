// Notices a wheel that comes near a wall of the bin, so that the run can end before it.
//
// A wheel of radius R and width w that travels along e takes R|e_x| + w/2 |e_y| of the bin along x from its centre, and
// across likewise. What is left to an end wall may come down to the given distance, to a side wall to half the wheel's
// width; a wheel that starts nearer than that to a wall may come half of the way.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "nodes/output/end_reason.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::ranks {

/// A wheel as walls know it.
struct WheelPlace {
  Vec3 center = Vec3::Zero();    // m
  Vec3 heading = Vec3::UnitX();  // unit, horizontal
  double radius = 0.0;           // m
  double width = 0.0;            // m
};

class WallWatch {
 public:
  /// @param wheels where they start
  WallWatch(const terrain::TerrainBounds& bounds, double stop_before, std::span<const WheelPlace> wheels);

  /// The kind of wall that a wheel is near, or nothing while all keep clear.
  std::optional<output::EndReason> near(std::span<const WheelPlace> wheels) const;

 private:
  static constexpr int kWalls = 4;
  using Distances = std::array<double, kWalls>;
  /// To the walls behind, ahead, to the right and to the left, m.
  Distances distances(const WheelPlace& wheel) const;

  double length_, width_;           // of the bin, m
  std::vector<Distances> nearest_;  // that each wheel may come to each wall, m
};

}  // namespace furrow::ranks
