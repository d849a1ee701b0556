// Suspensions and steering of a HMMWV from its published points, on soft vertical springs in place of tires: four double
// wishbones, a Pitman arm with link and idler in front, tie rods fixed to the chassis behind.
#pragma once

#include <numbers>
#include <vector>

#include "vehicle/multibody/system.hpp"

namespace furrow::testing {

struct Hmmwv {
  vehicle::System system;
  bool tires;
  int chassis = 0, link = 0;
  std::vector<int> uprights, spindles;  // front left, front right, rear left, rear right

  explicit Hmmwv(bool with_tires = true, const Vec3& gravity = standard_gravity())
      : system(gravity), tires(with_tires) {
    chassis = body("chassis", 2086.52, Vec3(1078.52, 2955.66, 3570.2), Vec3(0.056, 0, 0.213));
    add_steering();
    for (const bool front : {true, false})
      for (const double side : {1.0, -1.0}) add_corner(front, side);
    system.assemble(0.0);
  }

 private:
  using JointKind = vehicle::JointKind;

  int body(const char* name, double mass, const Vec3& inertia, const Vec3& at) {
    vehicle::BodyState state;
    state.position = at;
    return system.add_body(name, mass, inertia.asDiagonal(), state);
  }
  int joint(JointKind kind, const char* name, int a, int b, const Vec3& at, const Vec3& axis,
            const Vec3& second_point = Vec3::Zero(), const Vec3& second_axis = Vec3::UnitX()) {
    vehicle::JointPlace place;
    place.point = at;
    place.axis = axis;
    place.second_point = second_point;
    place.second_axis = second_axis;
    return system.add_joint(kind, name, a, b, place);
  }

  void add_steering() {
    const Mat3 pitched = Eigen::AngleAxisd(18.5 * std::numbers::pi / 180.0, Vec3::UnitY()).toRotationMatrix();
    const auto at = [&](double x, double y) {
      return Vec3(Vec3(1.24498, 0.0, 0.101322) + pitched * Vec3(x, y, 0));
    };
    const Vec3 up = pitched * Vec3::UnitZ(), forward = pitched * Vec3::UnitX();
    link = body("steering link", 3.681, Vec3(0.05, 0.05, 0.05), at(0.129, 0));
    const int arm = body("Pitman arm", 1.605, Vec3(0.01, 0.01, 0.01), at(0.0645, 0.249));
    const int pivot = joint(JointKind::revolute, "Pitman pivot", chassis, arm, at(0, 0.249), up);
    system.add_motor("steering", pivot, [](double t) { return vehicle::step_motion(t, 0.2, 0.5); });
    joint(JointKind::universal, "Pitman cross", arm, link, at(0.129, 0.249), up, Vec3::Zero(), forward);
    joint(JointKind::revolute_spherical, "idler", chassis, link, at(0, -0.325), up, at(0.129, -0.325));
  }

  /// `side`: 1 left, −1 right. Points in mm from the axle's origin.
  void add_corner(bool front, double side) {
    const auto at = [&](const Vec3& in_front, const Vec3& behind) {
      const Vec3 p = 1e-3 * (front ? in_front : behind);
      return Vec3((front ? 1.688965 : -1.688965) + p.x(), side * p.y(), p.z());
    };
    const Vec3 wheel = at({-40, 910, -26}, {36, 910, -26}), knuckle = at({-40, 751, -26}, {36, 751, -26});
    const Vec3 u1 = at({-48, 446, 245}, {349, 462, 228}), u2 = at({-268, 478, 196}, {77, 462, 224});
    const Vec3 l1 = at({223, 307, 0}, {223, 307, 0}), l2 = at({-223, 307, 0}, {-223, 307, 0});
    const Vec3 upper_ball = at({-53, 716, 215}, {36, 716, 216}),
               lower_ball = at({-36, 787, -118}, {-36, 787, -118});
    const int upright = body("upright", 19.45, Vec3(0.1656, 0.1934, 0.04367), knuckle);
    const int spindle = body("spindle with wheel", 93.5, Vec3(1.0, 2.0, 1.0), wheel);
    const int upper =
        body("upper arm", 5.813, Vec3(0.03, 0.03, 0.06276), at({-106, 589, 218}, {124, 589, 221}));
    const int lower = body("lower arm", 23.965, Vec3(0.4, 0.4, 0.8938), at({0, 547, -59}, {0, 547, -59}));
    joint(JointKind::revolute, "upper bushings", chassis, upper, 0.5 * (u1 + u2), u1 - u2);
    joint(JointKind::revolute, "lower bushings", chassis, lower, 0.5 * (l1 + l2), l1 - l2);
    joint(JointKind::spherical, "upper ball", upper, upright, upper_ball, Vec3::UnitZ());
    joint(JointKind::spherical, "lower ball", lower, upright, lower_ball, Vec3::UnitZ());
    joint(JointKind::revolute, "wheel bearing", upright, spindle, wheel, Vec3::UnitY());
    joint(JointKind::distance, "tie rod", front ? link : chassis, upright,
          at({-250, 448, 54}, {223, 416, 59}), Vec3::UnitZ(), at({-176, 821, -16}, {170, 821, -9}));
    system.add_line_element("strut", chassis, lower, at({104, 510, 197}, {-104, 502, 256}),
                            at({97, 543, -47}, {-97, 543, -47}),
                            vehicle::linear_spring_damper(167062, 0.3, 15e3));
    uprights.push_back(upright);
    spindles.push_back(spindle);
    if (!tires) return;
    system.add_line_element("tire", vehicle::kGround, spindle, wheel - Vec3(0, 0, 2.0), wheel,
                            vehicle::linear_spring_damper(3e5, 2.02, 3e3));
  }
};

}  // namespace furrow::testing
