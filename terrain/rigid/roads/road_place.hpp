// Where the heights of a file lie in the scenario.
#pragma once

namespace furrow::terrain {

inline constexpr double kFarthest = 1e6;  // m, of places and heights in a file, as entries of terrain.profile

struct RoadPlace {
  double v = 0.0;      // of the file at y = 0, m: v of OpenCRG, y of a grid; a profile has none
  double from = -1.0;  // x of its first height, m; negative: as the file says
  /// Whether the reference line of OpenCRG turns as the file says. It begins at `from` along x, with v = 0 at y = −v.
  bool curved = false;

  /// What is added to every x of a file whose first is `first`, m.
  double shift(double first) const { return from < 0.0 ? 0.0 : from - first; }
};

}  // namespace furrow::terrain
