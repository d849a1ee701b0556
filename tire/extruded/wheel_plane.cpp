#include "tire/extruded/wheel_plane.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

WheelPlane WheelPlane::of(const Quat& rim) {
  WheelPlane plane;
  plane.axis = rim * Vec3::UnitY();
  const Vec3 forward = plane.axis.cross(Vec3::UnitZ());
  FURROW_ASSERT(forward.norm() > 0.0, plane.axis.z());
  plane.forward = forward.normalized();
  plane.up = plane.forward.cross(plane.axis);
  return plane;
}

double WheelPlane::angle(const Quat& rim) const {
  const Vec3 top = rim * Vec3::UnitZ();
  return std::atan2(forward.dot(top), up.dot(top));
}

}  // namespace furrow::tire
