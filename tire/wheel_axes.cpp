#include "tire/wheel_axes.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

Wrench WheelAxes::wrench(const Vec3& force, const Vec3& moment, const Vec3& about) const {
  return {turn(force), turn(moment + (about - origin).cross(force))};
}

WheelAxes wheel_axes(const RimState& rim, const Vec3& travel, double ground) {
  FURROW_ASSERT(std::abs(travel.norm() - 1.0) < 1e-9, travel.transpose());
  FURROW_ASSERT((rim.orientation * Vec3::UnitY()).cross(Vec3::UnitZ()).norm() > 1e-6,
                rim.orientation.coeffs().transpose());
  FURROW_ASSERT((rim.orientation * Vec3::UnitY()).dot(Vec3::UnitZ().cross(travel)) != 0.0, travel.transpose());
  FURROW_ASSERT(std::isfinite(ground), ground);
  WheelAxes w;
  Vec3 axle = rim.orientation * Vec3::UnitY();
  if (axle.dot(w.z.cross(travel)) < 0.0) axle = -axle;
  w.x = axle.cross(w.z).normalized();
  w.y = w.z.cross(w.x);
  const Vec3 up = w.x.cross(axle);  // in the wheel plane
  w.loaded_radius = (rim.position.z() - ground) / up.z();
  w.origin = rim.position - w.loaded_radius * up;
  w.camber_angle = std::atan2(axle.z(), axle.dot(w.y));
  w.slip_angle = std::atan2(rim.velocity.dot(w.y), std::abs(rim.velocity.dot(w.x)));
  return w;
}

}  // namespace furrow::tire
