// The bin that contains the grains: a floor, and along x and y either rigid walls or periodic images.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

/// The walls of the bin as n·x ≥ offset, n inward: 0 x=0, 1 x=length, 2 y=−width/2, 3 y=width/2, 4 floor z=0.
inline constexpr int kWalls = 5;
inline constexpr int kFloor = 4;

struct Bin {
  static constexpr double kHigh = 1e6;  // above any grain, m
  double length = 0.0;                  // x from 0, m
  double width = 0.0;                   // y from −width/2, m
  bool periodic_x = false;              // grains that leave at one end enter at the other
  bool periodic_y = false;

  bool has_wall(int wall) const { return wall == kFloor || !(wall < 2 ? periodic_x : periodic_y); }
  /// Distance of a point from wall w, m.
  template <class Point>
  auto distance(int wall, const Point& p) const -> std::remove_cvref_t<decltype(p.x)> {
    switch (wall) {
      case 0:
        return p.x;
      case 1:
        return length - p.x;
      case 2:
        return p.y + 0.5 * width;
      case 3:
        return 0.5 * width - p.y;
      default:
        return p.z;
    }
  }
  static Triple<double> normal(int wall) {
    constexpr Triple<double> kNormal[kWalls] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    return kNormal[wall];
  }
  static const char* name(int wall) {
    constexpr const char* kName[kWalls] = {"the wall x = 0", "the wall x = length", "the wall y = -width/2",
                                           "the wall y = width/2", "the floor"};
    return kName[wall];
  }
  /// Whether a centre is within the walls and finite.
  bool holds(const Quad& p) const {
    return (periodic_x ? std::isfinite(p.x) : p.x >= 0.0 && p.x <= length) &&
           (periodic_y ? std::isfinite(p.y) : std::abs(p.y) <= 0.5 * width) && p.z >= 0.0 && p.z < kHigh;
  }
  /// Whether the bin contains a centre that is farther than `distance` ≥ 0 from each wall, m.
  bool holds_apart(const Quad& p, double distance) const {
    return (periodic_x ? std::isfinite(p.x) : p.x > distance && length - p.x > distance) &&
           (periodic_y ? std::isfinite(p.y) : 0.5 * width - std::abs(p.y) > distance) && p.z > distance && p.z < kHigh;
  }
  /// Moves a point back between the periodic sides.
  void wrap(Quad& p) const {
    if (periodic_x) p.x -= length * std::floor(p.x / length);
    if (periodic_y) p.y -= width * std::floor(p.y / width + 0.5);
  }
};

}  // namespace furrow::terrain::dem
