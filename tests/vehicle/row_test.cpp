// Every row's Jacobian against central differences of its value along random motions of both bodies.
#include "vehicle/multibody/row.hpp"

#include <gtest/gtest.h>

#include <random>

#include "vehicle/multibody/rotation.hpp"

using namespace furrow;

namespace {

struct Placed {
  Vec3 position;
  Quat orientation;
  Vec3 velocity, angular_velocity;
};

double value_after(const vehicle::Row& row, const Placed& a, const Placed& b, double t) {
  const Vec3 x_a = a.position + t * a.velocity, x_b = b.position + t * b.velocity;
  const Mat3 R_a = vehicle::rotated(a.orientation, a.angular_velocity, t).toRotationMatrix();
  const Mat3 R_b = vehicle::rotated(b.orientation, b.angular_velocity, t).toRotationMatrix();
  return vehicle::row_value(row, {&x_a, &R_a}, {&x_b, &R_b});
}

}  // namespace

TEST(Row, jacobian_matches_central_differences) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vec3(uniform(generator), uniform(generator), uniform(generator)); };
  const auto placed = [&] {
    return Placed{3.0 * vector(), Quat(Eigen::AngleAxisd(2.0 * uniform(generator), vector().normalized())), vector(),
                  vector()};
  };
  for (const vehicle::RowKind kind : {vehicle::RowKind::offset, vehicle::RowKind::dot, vehicle::RowKind::distance}) {
    for (int sample = 0; sample < 50; ++sample) {
      vehicle::Row row;
      row.kind = kind;
      row.point_a = vector();
      row.point_b = vector();
      row.axis_a = vector().normalized();
      row.axis_b = vector().normalized();
      const Placed a = placed(), b = placed();
      const Mat3 R_a = a.orientation.toRotationMatrix(), R_b = b.orientation.toRotationMatrix();
      const vehicle::RowJacobian J = vehicle::row_jacobian(row, {&a.position, &R_a}, {&b.position, &R_b});
      const double rate =
          J.v_a.dot(a.velocity) + J.w_a.dot(a.angular_velocity) + J.v_b.dot(b.velocity) + J.w_b.dot(b.angular_velocity);
      const double t = 1e-5;
      const double reference = (value_after(row, a, b, t) - value_after(row, a, b, -t)) / (2.0 * t);
      EXPECT_NEAR(rate, reference, 2e-9) << "kind " << static_cast<int>(kind);
    }
  }
}

TEST(Row, angle_jacobian_matches_central_differences_while_the_hinge_holds) {
  vehicle::Row row;
  row.kind = vehicle::RowKind::angle;
  const Quat common(Eigen::AngleAxisd(0.9, Vec3(1, -2, 0.5).normalized()));
  const Vec3 axis = common * Vec3::UnitZ(), shared(0.2, 0.7, -0.4);
  const Placed a{Vec3::Zero(), common, Vec3::Zero(), shared};
  const Placed b{Vec3::Zero(), Quat(Eigen::AngleAxisd(1.3, axis)) * common, Vec3::Zero(), shared + 2.5 * axis};
  const Mat3 R_a = a.orientation.toRotationMatrix(), R_b = b.orientation.toRotationMatrix();
  EXPECT_NEAR(vehicle::row_value(row, {&a.position, &R_a}, {&b.position, &R_b}), 1.3, 1e-15);
  const vehicle::RowJacobian J = vehicle::row_jacobian(row, {&a.position, &R_a}, {&b.position, &R_b});
  EXPECT_NEAR(J.w_a.dot(a.angular_velocity) + J.w_b.dot(b.angular_velocity), 2.5, 1e-14);
  const double t = 1e-5;
  EXPECT_NEAR((value_after(row, a, b, t) - value_after(row, a, b, -t)) / (2.0 * t), 2.5, 1e-9);
}

TEST(Row, angle_difference_takes_the_short_way_round) {
  vehicle::Row row;
  row.kind = vehicle::RowKind::angle;
  EXPECT_NEAR(vehicle::row_difference(row, 3.1, -3.1), 6.2 - 2.0 * std::acos(-1.0), 1e-15);
  EXPECT_NEAR(vehicle::row_difference(row, 0.5, 0.5 + 200.0 * std::acos(-1.0)), 0.0, 1e-12);
}
