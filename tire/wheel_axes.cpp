#include "tire/wheel_axes.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

Wrench WheelAxes::wrench(const Vec3& force, const Vec3& moment, const Vec3& about) const {
  return {turn(force), turn(moment + (about - origin).cross(force))};
}

WheelAxes wheel_axes(const RimState& rim, const Vec3& travel, const GroundPlane& ground) {
  Vec3 axle = rim.orientation * Vec3::UnitY();
  FURROW_ASSERT(std::abs(travel.norm() - 1.0) < 1e-9, travel.transpose());
  FURROW_ASSERT(axle.cross(ground.normal).norm() > 1e-6, rim.orientation.coeffs().transpose());
  FURROW_ASSERT(axle.dot(ground.normal.cross(travel)) != 0.0, travel.transpose());
  FURROW_ASSERT(ground.at.allFinite() && ground.normal.allFinite(), ground.at.transpose());
  WheelAxes w;
  w.z = ground.normal;
  w.ground = ground.at;
  if (axle.dot(w.z.cross(travel)) < 0.0) axle = -axle;
  w.x = axle.cross(w.z).normalized();
  w.y = w.z.cross(w.x);
  const Vec3 up = w.x.cross(axle);  // in the wheel plane
  w.loaded_radius = (rim.position - ground.at).dot(w.z) / up.dot(w.z);
  w.origin = rim.position - w.loaded_radius * up;
  w.camber_angle = std::atan2(axle.dot(w.z), axle.dot(w.y));
  w.slip_angle = std::atan2(rim.velocity.dot(w.y), std::abs(rim.velocity.dot(w.x)));
  return w;
}

WheelAxes wheel_axes(const RimState& rim, const Vec3& travel, double ground) {
  return wheel_axes(rim, travel, GroundPlane{.at = {0.0, 0.0, ground}});
}

}  // namespace furrow::tire
