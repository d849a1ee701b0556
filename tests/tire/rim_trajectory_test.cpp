// The bead's motion between two received rim states.
#include "tire/rim_trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace furrow::tire {
namespace {

RimState spinning(double time, const Vec3& omega) {
  RimState r;
  r.position = Vec3(4.0 * time, 0, 0.46);
  r.velocity = Vec3(4, 0, 0);
  r.angular_velocity = omega;
  r.orientation = Quat(Eigen::AngleAxisd(omega.norm() * time, omega.normalized()));
  return r;
}

TEST(RimTrajectory, steady_spin_is_followed_exactly) {
  const Vec3 omega(0, 8.56, 0);
  const double h = 4e-5;
  RimTrajectory t(spinning(0, omega));
  for (int n = 0; n < 100; ++n) t.extend(spinning(n * h, omega), h);
  const RimKinematics middle = t.at(0.5);
  const RimState exact = spinning(99.5 * h, omega);
  EXPECT_LT((middle.state.position - exact.position).norm(), 1e-14);
  EXPECT_LT((middle.state.orientation.toRotationMatrix() - exact.orientation.toRotationMatrix()).norm(), 1e-13);
  EXPECT_LT((middle.state.angular_velocity - omega).norm(), 1e-9);
}

TEST(RimTrajectory, position_and_velocity_are_continuous_across_intervals_when_the_rim_accelerates) {
  RimTrajectory t{RimState{}};
  const double h = 1e-3;
  RimState end_before;
  for (int n = 0; n < 20; ++n) {
    RimState r;
    r.position = Vec3(0.5 * 9.0 * n * n * h * h, 0, 0);
    r.velocity = Vec3(9.0 * n * h, 0, 0);
    t.extend(r, h);
    const RimKinematics start = t.at(0.0);
    EXPECT_LT((start.state.position - end_before.position).norm(), 1e-15);
    EXPECT_LT((start.state.velocity - end_before.velocity).norm(), 1e-12);
    end_before = t.at(1.0).state;
    EXPECT_LT((end_before.velocity - r.velocity).norm(), 1e-12);
  }
}

/// The largest |x| over the last tenth of 10^4 steps of a mass on a spring, ω H = h, released at x = 1. The spring's
/// force is taken at the trajectory's mean and acts over its interval.
double amplitude_after(double h, bool accelerated) {
  RimState rim;
  rim.position.x() = 1.0;
  RimTrajectory t(rim);
  double largest = 0.0;
  for (int n = 0; n < 10000; ++n) {
    accelerated ? t.extend_accelerated(rim, 1.0) : t.extend(rim, 1.0);
    const double a = -h * h * 0.5 * (t.start().position.x() + t.end().position.x());
    rim.position.x() += rim.velocity.x() + 0.5 * a;
    rim.velocity.x() += a;
    if (n >= 9000) largest = std::max(largest, std::abs(rim.position.x()));
  }
  return largest;
}

TEST(RimTrajectory, a_body_on_a_spring_is_stable_with_the_last_acceleration_and_damped_as_stated) {
  for (const double h : {0.05, 0.1, 0.3, 0.6, 0.9}) EXPECT_LT(amplitude_after(h, true), 1.01) << h;
  EXPECT_GT(amplitude_after(0.3, false), 1e3);
  // ζ = h³/8: the amplitude falls by exp(−ζ h n).
  const double h = 0.05, expected = std::exp(-h * h * h / 8.0 * h * 9000.0);
  EXPECT_NEAR(amplitude_after(h, true), expected, 0.02 * expected);
}

TEST(RimTrajectory, rates_are_derivatives_of_the_poses) {
  RimTrajectory t(spinning(0, Vec3(0.1, 8, 0.2)));
  RimState next = spinning(1e-3, Vec3(0.3, 9, -0.1));
  next.position += Vec3(1e-4, 2e-4, 0);
  t.extend(next, 1e-3);
  const double s = 0.4, d = 1e-5;
  const RimKinematics low = t.at(s - d), high = t.at(s + d), here = t.at(s);
  EXPECT_LT(((high.state.position - low.state.position) / (2 * d * 1e-3) - here.state.velocity).norm(), 1e-6);
  EXPECT_LT(((high.state.velocity - low.state.velocity) / (2 * d * 1e-3) - here.acceleration).norm(), 1e-4);
}

}  // namespace
}  // namespace furrow::tire
