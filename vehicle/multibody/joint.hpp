// Joints as sets of constraint rows, built from the assembled configuration.
#pragma once

#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/row.hpp"

namespace furrow::vehicle {

/// Rows (constrained degrees of freedom): fixed 6, revolute 5, prismatic 5, cylindrical 4, universal 4,
/// spherical 3, distance 1, revolute–spherical 2.
///
/// Two kinds represent a massless rod. Distance has a ball at one end and a ball or a universal joint at the other.
/// Revolute–spherical has a hinge on A and a ball on B, so that B's point stays on a circle about the hinge.
enum class JointKind { fixed, revolute, prismatic, cylindrical, universal, spherical, distance, revolute_spherical };

/// Position of a joint in the configuration in which it is defined, W.
struct JointPlace {
  Vec3 point = Vec3::Zero();         // m; of a rod: its end on A
  Vec3 axis = Vec3::UnitZ();         // revolute, prismatic, cylindrical: the axis; universal, rod: the axis in A
  Vec3 second_axis = Vec3::UnitX();  // universal: the axis fixed in B
  Vec3 second_point = Vec3::Zero();  // of a rod: its end on B, m
};

/// Frame of a joint in body axes: z along the joint axis.
struct JointFrame {
  Vec3 origin = Vec3::Zero();    // m
  Mat3 axes = Mat3::Identity();  // columns x, y, z
};

struct Joint {
  std::string name;
  JointKind kind = JointKind::fixed;
  int a = kGround, b = kGround;
  JointFrame frame_a, frame_b;
  int first_row = 0, row_count = 0;  // in the system's list of constraint rows
};

/// Reaction of a joint: force on B by A and its moment about the joint point of B.
struct Reaction {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};
void visit_fields(FieldsOf<Reaction> auto& s, auto&& visit) {
  visit(s.force, Field{"force", "N"});
  visit(s.moment, Field{"moment", "N m"});
}

/// Fills the joint's frames from the poses of its bodies and the place, and returns its rows.
/// @throws Error(physics) for a zero axis, parallel axes of a universal joint, a rod without length or along its hinge.
std::vector<Row> make_joint_rows(Joint& joint, const Pose& A, const Pose& B, const JointPlace& place);

/// Right-handed axes with z along the given direction.
Mat3 axes_about(const Vec3& z);

/// The free coordinate of a joint that a motor or force element acts on: displacement along z (prismatic,
/// cylindrical) or angle about z (revolute).
/// @throws Error(physics) for a joint without such a coordinate.
Row free_coordinate(const Joint& joint);

}  // namespace furrow::vehicle
