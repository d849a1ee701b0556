// Bodies and joints for mechanisms in the x–z plane, hinged about y.
#pragma once

#include <cmath>

#include "vehicle/multibody/system.hpp"

namespace furrow::testing {

/// A bar with its centre at `centre`, turned by `angle` about y; its own z axis is along the bar.
inline vehicle::BodyState bar_state(const Vec3& centre, double angle) {
  vehicle::BodyState state;
  state.position = centre;
  state.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  return state;
}

inline vehicle::JointPlace hinge(const Vec3& point) {
  vehicle::JointPlace place;
  place.point = point;
  place.axis = Vec3::UnitY();
  return place;
}

inline vehicle::JointPlace slide(const Vec3& point, const Vec3& axis) {
  vehicle::JointPlace place;
  place.point = point;
  place.axis = axis;
  return place;
}

}  // namespace furrow::testing
