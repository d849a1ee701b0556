// The wheel's plane and the rim's angle in it. With the rim's axis a, the plane is spanned by the horizontal a × z and
// by the normal to a × z and a.
#pragma once

#include "protocol/core/vec.hpp"
#include "tire/extruded/plane_vectors.hpp"

namespace furrow::tire {

struct WheelPlane {
  Vec3 forward, up, axis;  // unit vectors, W
  Vec3 out(PlanarPoint p) const { return p.x * forward + p.z * up; }
  PlanarPoint in(const Vec3& v) const { return {forward.dot(v), up.dot(v)}; }
  Vec3 along(const Vec3& v) const { return axis.dot(v) * axis; }  // the part along the axis
  Vec3 across(const Vec3& v) const { return v - along(v); }       // the part in the plane
  /// @pre the rim's axis is not vertical
  static WheelPlane of(const Quat& rim);
  /// Angle by which a rim is turned about its axis, rad.
  double angle(const Quat& rim) const;
};

}  // namespace furrow::tire
