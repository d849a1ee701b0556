#include "vehicle/multibody/rotation.hpp"

#include <gtest/gtest.h>

using namespace furrow;

TEST(Rotation, exponential_matches_axis_angle_from_tiny_to_large) {
  const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
  for (const double angle : {1e-12, 1e-6, 9.9e-4, 1.01e-3, 0.1, 1.0, 3.0, 6.0}) {
    const Quat reference(Eigen::AngleAxisd(angle, axis));
    EXPECT_LT((vehicle::rotation_exp(angle * axis).coeffs() - reference.coeffs()).norm(), 4e-16) << angle;
  }
}

TEST(Rotation, midpoint_velocity_satisfies_its_equation) {
  const Mat3 R = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  const Mat3 J = Vec3(1.0, 2.0, 4.0).asDiagonal();
  const Vec3 momentum(3.0, -2.0, 5.0);
  const double h = 0.02;
  Vec3 omega;
  ASSERT_TRUE(vehicle::midpoint_angular_velocity(R, J.inverse(), momentum, h, omega));
  const Mat3 R_half = vehicle::rotation_exp(0.5 * h * omega).toRotationMatrix() * R;
  EXPECT_LT((R_half * J * R_half.transpose() * omega - momentum).norm(), 1e-14 * momentum.norm());
}

TEST(Rotation, midpoint_velocity_says_when_the_step_is_too_long) {
  Vec3 omega;
  const Mat3 J_inverse = Vec3(1.0, 0.1, 10.0).asDiagonal();
  EXPECT_FALSE(vehicle::midpoint_angular_velocity(Mat3::Identity(), J_inverse, Vec3(300.0, 200.0, 100.0), 0.1, omega));
}
