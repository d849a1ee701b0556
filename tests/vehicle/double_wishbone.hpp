// Independent kinematics of a double wishbone: Newton's method finds five points of the upright from distances alone.
// The wheel is lifted and the tie rod moved in small steps, so that the posture stays on the branch of the drawn one.
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::testing {

class DoubleWishbone {
 public:
  enum Point { kUpper, kLower, kRod, kCenter, kAxle, kCount };
  using Points = std::array<Vec3, kCount>;

  /// One side, from its spec, in the vehicle's frame.
  explicit DoubleWishbone(const vehicle::DoubleWishboneSpec& spec) : spec_(spec) {
    drawn_ = {spec.upper_arm.upright, spec.lower_arm.upright, spec.tie_rod.outer, spec.spindle.center,
              Vec3(spec.spindle.center + 0.2 * Vec3::UnitY())};
    spring_on_arm_ = lower_arm_axes(drawn_).transpose() * (spec.spring->end - spec.lower_arm.chassis_back);
  }

  /// The points with the wheel's centre lifted by `travel` and the tie rod's inner end moved by `rod`.
  Points solve(double travel, const Vec3& rod = Vec3::Zero()) const {
    Vector x;
    for (int k = 0; k < kCount; ++k) x.segment<3>(3 * k) = drawn_[k];
    constexpr int kSteps = 8;
    for (int step = 1; step <= kSteps; ++step)
      for (int iteration = 0; iteration < 20; ++iteration) {
        const double share = static_cast<double>(step) / kSteps;
        const Vector residual = residuals(x, share * travel, share * rod);
        Eigen::Matrix<double, 15, 15> J;
        for (int k = 0; k < 15; ++k) {
          Vector up = x, down = x;
          up[k] += 1e-6;
          down[k] -= 1e-6;
          J.col(k) = (residuals(up, share * travel, share * rod) - residuals(down, share * travel, share * rod)) / 2e-6;
        }
        x -= J.partialPivLu().solve(residual);
        if (residual.norm() < 1e-14) break;
      }
    Points points;
    for (int k = 0; k < kCount; ++k) points[k] = x.segment<3>(3 * k);
    return points;
  }

  double spring_length(const Points& p) const {
    return (spec_.lower_arm.chassis_back + lower_arm_axes(p) * spring_on_arm_ - spec_.spring->chassis).norm();
  }

  /// Axes of the upright from three of its points.
  static Mat3 upright_axes(const Points& p) {
    Mat3 axes;
    axes.col(0) = (p[kUpper] - p[kLower]).normalized();
    axes.col(1) = (p[kRod] - p[kLower]).cross(axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  }

 private:
  using Vector = Eigen::Matrix<double, 15, 1>;

  Mat3 lower_arm_axes(const Points& p) const {
    Mat3 axes;
    axes.col(0) = (spec_.lower_arm.chassis_front - spec_.lower_arm.chassis_back).normalized();
    axes.col(1) = axes.col(0).cross(p[kLower] - spec_.lower_arm.chassis_back).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  }

  Vector residuals(const Vector& x, double travel, const Vec3& rod) const {
    const auto at = [&](int k) { return Vec3(x.segment<3>(3 * k)); };
    Vector r;
    int i = 0;
    const auto from_fixed = [&](int k, const Vec3& point, const Vec3& drawn) {
      r[i++] = (at(k) - point).norm() - (drawn_[k] - drawn).norm();
    };
    const auto between = [&](int a, int b) { r[i++] = (at(a) - at(b)).norm() - (drawn_[a] - drawn_[b]).norm(); };
    from_fixed(kUpper, spec_.upper_arm.chassis_front, spec_.upper_arm.chassis_front);
    from_fixed(kUpper, spec_.upper_arm.chassis_back, spec_.upper_arm.chassis_back);
    from_fixed(kLower, spec_.lower_arm.chassis_front, spec_.lower_arm.chassis_front);
    from_fixed(kLower, spec_.lower_arm.chassis_back, spec_.lower_arm.chassis_back);
    from_fixed(kRod, spec_.tie_rod.inner + rod, spec_.tie_rod.inner);
    between(kUpper, kLower);
    between(kRod, kUpper);
    between(kRod, kLower);
    for (const int k : {kCenter, kAxle})
      for (const int other : {kUpper, kLower, kRod}) between(k, other);
    r[i++] = x[3 * kCenter + 2] - drawn_[kCenter].z() - travel;
    return r;
  }

  vehicle::DoubleWishboneSpec spec_;
  Points drawn_;
  Vec3 spring_on_arm_;
};

}  // namespace furrow::testing
