// Where a spin axis stands in a wheel's plane and around it. The plane is spanned by a × z, horizontal, and by what is
// normal to it and to the rim's axis a.
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
  /// By which a rim is turned about its axis, rad.
  double angle(const Quat& rim) const;
};

}  // namespace furrow::tire
