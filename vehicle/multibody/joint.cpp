#include "vehicle/multibody/joint.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

JointFrame in_body(const Pose& body, const Vec3& point_W, const Mat3& axes_W) {
  FURROW_ASSERT(body.R != nullptr && body.position != nullptr, point_W.transpose());
  return {body.R->transpose() * (point_W - *body.position), body.R->transpose() * axes_W};
}

Row base_row(const Joint& joint, RowKind kind) {
  Row row;
  row.kind = kind;
  row.a = joint.a;
  row.b = joint.b;
  row.point_a = joint.frame_a.origin;
  row.point_b = joint.frame_b.origin;
  return row;
}

Row offset_row(const Joint& joint, int axis) {
  FURROW_ASSERT(in_range(axis, 3), axis);
  Row row = base_row(joint, RowKind::offset);
  row.axis_a = joint.frame_a.axes.col(axis);
  return row;
}

Row dot_row(const Joint& joint, int axis_of_a, int axis_of_b) {
  FURROW_ASSERT(in_range(axis_of_a, 3) && in_range(axis_of_b, 3), axis_of_a, axis_of_b);
  Row row = base_row(joint, RowKind::dot);
  row.axis_a = joint.frame_a.axes.col(axis_of_a);
  row.axis_b = joint.frame_b.axes.col(axis_of_b);
  return row;
}

}  // namespace

Mat3 axes_about(const Vec3& direction) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) throw physics_error("a joint axis has no direction");
  const Vec3 z = direction / length;
  int least = 0;  // world axis with the smallest component along z
  z.cwiseAbs().minCoeff(&least);
  Mat3 axes;
  axes.col(2) = z;
  axes.col(0) = (Vec3::Unit(least) - z[least] * z).normalized();
  axes.col(1) = z.cross(axes.col(0));
  return axes;
}

namespace {

Mat3 joint_axes(const Joint& joint, const JointPlace& place) {
  Mat3 axes = axes_about(place.axis);
  if (joint.kind != JointKind::universal) return axes;
  // x fixed in A, y fixed in B, z across both: the joint's cross at assembly.
  const Vec3 normal = place.axis.normalized().cross(place.second_axis.normalized());
  if (!(normal.norm() > 1e-6)) throw physics_error("joint '" + joint.name + "': its two axes are parallel");
  axes.col(0) = place.axis.normalized();
  axes.col(2) = normal.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace

std::vector<Row> make_joint_rows(Joint& joint, const Pose& A, const Pose& B, const JointPlace& place) {
  const bool rod = joint.kind == JointKind::distance || joint.kind == JointKind::revolute_spherical;
  const Vec3 point_b = rod ? place.second_point : place.point;
  const Mat3 axes = joint_axes(joint, place);
  joint.frame_a = in_body(A, place.point, axes);
  joint.frame_b = in_body(B, point_b, axes);
  std::vector<Row> rows;
  const auto is = [&](auto... kinds) { return ((joint.kind == kinds) || ...); };
  using enum JointKind;
  if (!rod)
    for (int axis = 0; axis < (is(prismatic, cylindrical) ? 2 : 3); ++axis) rows.push_back(offset_row(joint, axis));
  if (is(fixed, revolute, prismatic, cylindrical))
    rows.push_back(dot_row(joint, 0, 2)), rows.push_back(dot_row(joint, 1, 2));
  if (is(fixed, prismatic, universal)) rows.push_back(dot_row(joint, 0, 1));
  if (is(distance)) {
    rows.push_back(base_row(joint, RowKind::distance));
    rows.back().reference = (point_b - place.point).norm();
    if (!(rows.back().reference > 0.0)) throw physics_error("joint '" + joint.name + "': its length is zero");
  }
  if (is(revolute_spherical)) {
    // The point does not move along the hinge; across it the length is constant.
    const Vec3 across = axes.transpose() * (point_b - place.point);
    if (!(across.head<2>().norm() > 1e-9))
      throw physics_error("joint '" + joint.name + "': its two ends lie on the hinge");
    rows.push_back(offset_row(joint, 2));
    rows.back().reference = across.z();
    rows.push_back(base_row(joint, RowKind::distance));
    rows.back().reference = across.norm();
  }
  return rows;
}

Row free_coordinate(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::prismatic:
    case JointKind::cylindrical:
      return offset_row(joint, 2);
    case JointKind::revolute: {
      Row row = dot_row(joint, 0, 0);
      row.kind = RowKind::angle;
      row.hinge_a = joint.frame_a.axes.col(2);
      return row;
    }
    default:
      throw physics_error("joint '" + joint.name + "' has no coordinate that could be driven");
  }
}

}  // namespace furrow::vehicle
