// Scalar coordinates between two bodies A and B. They are the building blocks of constraints (a joint is a set of rows
// that must vanish), of motors (a row that must follow a function of time) and of force elements.
//
//   offset    φ = e_A · (P_B − P_A)            e fixed in A
//   dot       φ = a_A · b_B                    both unit vectors fixed in their bodies
//   distance  φ = |P_B − P_A|
//   angle     φ = angle from x_A to x_B about z_A, in (−π, π]
//
// A force λ in a row does the virtual work λ δφ: positive pushes B along e, pushes the points apart, turns B
// positively about z_A relative to A.
#pragma once

#include "vehicle/multibody/body.hpp"

namespace furrow::vehicle {

enum class RowKind { offset, dot, distance, angle };

struct Row {
  RowKind kind = RowKind::offset;
  int a = kGround, b = kGround;
  Vec3 point_a = Vec3::Zero();   // in A, m
  Vec3 point_b = Vec3::Zero();   // in B, m
  Vec3 axis_a = Vec3::UnitX();   // in A: e, a or x_A
  Vec3 axis_b = Vec3::UnitX();   // in B: b or x_B
  Vec3 hinge_a = Vec3::UnitZ();  // in A: z_A of an angle row
  double reference = 0.0;        // constant part of the target, m or rad
};

/// Derivative of φ with respect to the velocities and angular velocities (W) of A and B.
struct RowJacobian {
  Vec3 v_a, w_a, v_b, w_b;
};

/// Calls call(body, v, w) for A and then B, but not for the ground.
template <class Call>
void each_side(const Row& row, const RowJacobian& J, const Call& call) {
  if (row.a != kGround) call(row.a, J.v_a, J.w_a);
  if (row.b != kGround) call(row.b, J.v_b, J.w_b);
}

/// Position and orientation of a body, or of the ground, as rows use them.
struct Pose {
  const Vec3* position;
  const Mat3* R;
};

double row_value(const Row& row, const Pose& A, const Pose& B);
RowJacobian row_jacobian(const Row& row, const Pose& A, const Pose& B);

/// φ − target, wrapped to (−π, π] for angles.
double row_difference(const Row& row, double value, double target);

}  // namespace furrow::vehicle
