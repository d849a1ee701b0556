// Notices a wheel that approaches a wall of the bin, so that the run can end before it.
//
// A wheel of radius R and width w that travels along e extends R|e_x| + w/2 |e_y| along x from its centre, and R|e_y| +
// w/2 |e_x| across. It may approach an end wall up to the given distance, and a side wall up to half its width. A wheel
// that starts nearer to a wall than that may go half of the way.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "nodes/output/end_reason.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/terrain_spec.hpp"

namespace furrow::ranks {

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

  /// The kind of wall that a wheel is near; none while all keep clear.
  std::optional<output::EndReason> near(std::span<const WheelPlace> wheels) const;

 private:
  static constexpr int kWalls = 4;
  using Distances = std::array<double, kWalls>;
  /// Distances to the walls behind, ahead, to the right and to the left, m.
  Distances distances(const WheelPlace& wheel) const;

  double length_, width_;           // of the bin, m
  std::vector<Distances> nearest_;  // smallest allowed distance of each wheel from each wall, m
};

}  // namespace furrow::ranks
