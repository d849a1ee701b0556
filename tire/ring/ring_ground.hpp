// The ground under a ring: a polyline z(x) seen from the side, rigid and without friction. Its faces carry segments of
// the ring; its convex corners and its two ends carry the belt between segments. There is no ground beyond the ends. So
// two points make a bar whose base is never touched, and two points far apart make a plate.
#pragma once

#include <vector>

#include "tire/extruded/plane_vectors.hpp"

namespace furrow::tire {

using GroundPoint = PlanarPoint;  // m

class RingGround {
 public:
  using Point = GroundPoint;

  /// @pre two points at least, x strictly increasing, all finite
  explicit RingGround(std::vector<GroundPoint> points);
  /// A flat plate at z = 0, long enough for tires of up to this radius.
  static RingGround plate(double radius);
  /// A bar with its top at z = 0, from −width/2 to width/2 about `position`. @pre width > 0
  static RingGround bar(double width, double position);

  /// Points that can carry the belt between segments.
  const std::vector<GroundPoint>& corners() const { return corners_; }
  double top() const { return top_; }  // m

  /// Index of the face, between points i and i + 1, that is above or below x; −1 beyond the ends.
  int face(double x) const;
  double slope(int face) const;
  double height(int face, double x) const;
  /// Distance along a ray from (x, z), at the angle θ from straight down, to the first face that it meets from above;
  /// infinite if there is none. @pre |θ| < π/2
  double distance(double x, double z, double angle) const;

 private:
  std::vector<GroundPoint> points_, corners_;
  double top_ = 0.0;
};

}  // namespace furrow::tire
