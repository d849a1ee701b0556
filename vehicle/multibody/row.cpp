#include "vehicle/multibody/row.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {

double row_value(const Row& row, const Pose& A, const Pose& B) {
  FURROW_ASSERT(A.R != nullptr && B.R != nullptr, row.a, row.b);
  FURROW_ASSERT(A.position != nullptr && B.position != nullptr, row.a, row.b);
  switch (row.kind) {
    case RowKind::dot:
      return (*A.R * row.axis_a).dot(*B.R * row.axis_b);
    case RowKind::angle: {
      const Vec3 x_a = *A.R * row.axis_a, z_a = *A.R * row.hinge_a, x_b = *B.R * row.axis_b;
      return std::atan2(x_b.dot(z_a.cross(x_a)), x_b.dot(x_a));
    }
    case RowKind::offset:
    case RowKind::distance:
      break;
  }
  const Vec3 d = (*B.position + *B.R * row.point_b) - (*A.position + *A.R * row.point_a);
  return row.kind == RowKind::offset ? (*A.R * row.axis_a).dot(d) : d.norm();
}

RowJacobian row_jacobian(const Row& row, const Pose& A, const Pose& B) {
  FURROW_ASSERT(A.R != nullptr && B.R != nullptr, row.a, row.b);
  FURROW_ASSERT(A.position != nullptr && B.position != nullptr, row.a, row.b);
  RowJacobian J;
  if (row.kind == RowKind::dot) {
    // d(a·b)/dt = (ω_A × a)·b + a·(ω_B × b) = ω_A·(a × b) − ω_B·(a × b)
    const Vec3 n = (*A.R * row.axis_a).cross(*B.R * row.axis_b);
    J.v_a.setZero();
    J.v_b.setZero();
    J.w_a = n;
    J.w_b = -n;
    return J;
  }
  if (row.kind == RowKind::angle) {
    // Exact while z_A and z_B coincide; the joint that has the angle ensures this.
    const Vec3 z = *A.R * row.hinge_a;
    J.v_a.setZero();
    J.v_b.setZero();
    J.w_a = -z;
    J.w_b = z;
    return J;
  }
  const Vec3 r_a = *A.R * row.point_a, r_b = *B.R * row.point_b;
  const Vec3 d = (*B.position + r_b) - (*A.position + r_a);
  if (row.kind == RowKind::offset) {
    // d(e·d)/dt = e·(v_B + ω_B × r_B − v_A − ω_A × r_A) + (ω_A × e)·d
    const Vec3 e = *A.R * row.axis_a;
    J.v_a = -e;
    J.w_a = -(r_a + d).cross(e);
    J.v_b = e;
    J.w_b = r_b.cross(e);
  } else {
    const Vec3 u = d.normalized();
    J.v_a = -u;
    J.w_a = -r_a.cross(u);
    J.v_b = u;
    J.w_b = r_b.cross(u);
  }
  return J;
}

double row_difference(const Row& row, double value, double target) {
  const double difference = value - target;
  return row.kind == RowKind::angle ? std::remainder(difference, 2.0 * std::numbers::pi) : difference;
}

}  // namespace furrow::vehicle
