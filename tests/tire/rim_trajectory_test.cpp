// The bead's motion between two received rim states.
#include "tire/rim_trajectory.hpp"

#include <gtest/gtest.h>

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
