// What a planar tire stands on: a rigid polyline with its solid on the right-hand side when it is walked along from its
// first point to its last, so that a road from left to right has its solid below. Faces may stand upright: a curb.
// Beyond the ends there is nothing.
#pragma once

#include <vector>

#include "tire/extruded/plane_vectors.hpp"

namespace furrow::tire {

/// How deep a point lies in the solid, and where the nearest side is.
struct PlanarDepth {
  double depth = 0.0;               // m; 0: not in it
  double out_x = 0.0, out_z = 0.0;  // unit vector from the point to the nearest side
};

class PlanarGround {
 public:
  using Point = PlanarPoint;

  /// @pre two points at least, finite, x not decreasing, no two the same
  explicit PlanarGround(std::vector<PlanarPoint> points);
  /// Flat at z = 0 for tires of a radius up to this.
  static PlanarGround plate(double radius);
  /// A flat-topped bar with upright sides, its top at z = 0, whose base is never touched. @pre width > 0
  static PlanarGround bar(double width, double position);
  /// Flat at z = 0 up to x = 0, at `height` from there on; of a length to both sides.
  static PlanarGround curb(double height, double length);

  const std::vector<PlanarPoint>& points() const { return points_; }
  double top() const { return top_; }  // of all points, m

  PlanarDepth depth(double x, double z) const;

  /// Convex corners, ends among them, by growing x.
  const std::vector<PlanarPoint>& corners() const { return corners_; }

 private:
  double height(double x) const;

  std::vector<PlanarPoint> points_, corners_;
  double top_ = 0.0;
};

}  // namespace furrow::tire
