// The ground under a planar tire: a rigid polyline. Its solid is on the right-hand side of the direction from first to
// last point, so a road from left to right has its solid below. Faces may be vertical, as at a curb. There is no ground
// beyond the ends.
#pragma once

#include <vector>

#include "tire/extruded/plane_vectors.hpp"

namespace furrow::tire {

/// Depth of a point in the solid, and the direction to the nearest side.
struct PlanarDepth {
  double depth = 0.0;               // m; 0: outside
  double out_x = 0.0, out_z = 0.0;  // unit vector from the point to the nearest side
};

class PlanarGround {
 public:
  using Point = PlanarPoint;

  /// @pre two points at least, finite, x not decreasing, no two the same
  explicit PlanarGround(std::vector<PlanarPoint> points);
  /// Flat at z = 0, long enough for tires of up to this radius.
  static PlanarGround plate(double radius);
  /// A flat-topped bar with vertical sides and its top at z = 0; its base is never touched. @pre width > 0
  static PlanarGround bar(double width, double position);
  /// Flat at z = 0 up to x = 0 and at `height` from there on; extends by `length` to both sides.
  static PlanarGround curb(double height, double length);

  double top() const { return top_; }  // of all points, m

  PlanarDepth depth(double x, double z) const;

  /// Convex corners, with the ends, by increasing x.
  const std::vector<PlanarPoint>& corners() const { return corners_; }

 private:
  double height(double x) const;

  std::vector<PlanarPoint> points_, corners_;
  double top_ = 0.0;
};

}  // namespace furrow::tire
