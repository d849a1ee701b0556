#include "nodes/ranks/wall_watch.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::ranks {
namespace {

constexpr int kEndWalls = 2;  // are the first ones

}  // namespace

WallWatch::WallWatch(const terrain::TerrainBounds& bounds, double stop_before, std::span<const WheelPlace> wheels)
    : length_(bounds.length), width_(bounds.width) {
  FURROW_ASSERT(stop_before > 0.0, stop_before);
  for (const WheelPlace& wheel : wheels) {
    Distances nearest = distances(wheel);
    for (int wall = 0; wall < kWalls; ++wall) {
      const double wanted = wall < kEndWalls ? stop_before : 0.5 * wheel.width;
      nearest[wall] = nearest[wall] > wanted ? wanted : 0.5 * nearest[wall];
    }
    nearest_.push_back(nearest);
  }
}

WallWatch::Distances WallWatch::distances(const WheelPlace& wheel) const {
  const double x = std::abs(wheel.heading.x()), y = std::abs(wheel.heading.y()), half = 0.5 * wheel.width;
  const double along = wheel.radius * x + half * y, across = wheel.radius * y + half * x;
  return {wheel.center.x() - along, length_ - wheel.center.x() - along, 0.5 * width_ + wheel.center.y() - across,
          0.5 * width_ - wheel.center.y() - across};
}

std::optional<output::EndReason> WallWatch::near(std::span<const WheelPlace> wheels) const {
  FURROW_ASSERT(wheels.size() == nearest_.size(), wheels.size(), nearest_.size());
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const Distances now = distances(wheels[k]);
    for (int wall = 0; wall < kWalls; ++wall)
      if (now[wall] < nearest_[k][wall])
        return wall < kEndWalls ? output::EndReason::end_wall : output::EndReason::side_wall;
  }
  return std::nullopt;
}

}  // namespace furrow::ranks
