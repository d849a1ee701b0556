// The rig's report against its given wrench: pull, torque, lateral force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/constants.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {
const double kTolerance = 1e-6;  // N, N m: round-off of 470 kg × 4 m/s in one step of 4e-5 s
}

TEST(DrawbarPull, equals_the_force_on_the_rim_in_steady_state) {
  const rigs::DrawbarRigOptions options = steady_options();
  const auto rig = placed_rig(options);
  const double weight = carried_mass(options) * kStandardGravity;
  for (const double force : {1500.0, -400.0, 0.0}) {
    advance(*rig, wrench(Vec3(force, 0, weight)), 20);
    EXPECT_NEAR(measured(*rig, "drawbar_pull_N"), force, kTolerance);
    EXPECT_NEAR(measured(*rig, "drawbar_pull_raw_N"), force, kTolerance);
  }
}

TEST(DrawbarPull, without_tire_force_a_ramp_shows_only_in_the_raw_pull) {
  rigs::DrawbarRigOptions options = reference_options();
  options.ramp = 0.2;
  const auto rig = placed_rig(options);
  const double speed = options.angular_speed * kRadius * (1.0 - options.slip);
  const double mass = carried_mass(options) + options.chassis_mass + options.set_toe_mass;
  double largest = 0.0, before = 0.0;
  for (int i = 1; i <= 5500; ++i) {
    advance(*rig, Wrench{}, 1);
    const double u = std::min(1.0, i * kStep / options.ramp);
    const double now = speed * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    ASSERT_NEAR(measured(*rig, "drawbar_pull_N"), 0.0, kTolerance) << i;
    ASSERT_NEAR(measured(*rig, "drawbar_pull_raw_N"), -mass * (now - before) / kStep, 1e-5) << i;
    largest = std::max(largest, -measured(*rig, "drawbar_pull_raw_N"));
    before = now;
  }
  // Peak acceleration of the C² ramp: 15/8 v/T.
  EXPECT_NEAR(largest, mass * 1.875 * speed / options.ramp, 1e-3 * largest);
  EXPECT_NEAR(measured(*rig, "drawbar_pull_raw_N"), 0.0, kTolerance);
}

TEST(DrawbarPull, is_exact_in_the_ramp_with_substeps_and_force) {
  rigs::DrawbarRigOptions options = reference_options();
  const auto rig = placed_rig(options);
  for (int i = 0; i < 300; ++i) {
    advance(*rig, wrench(Vec3(-820.0, 30.0, 4000.0), Vec3(10, -200, 5)), 1, 4e-4, 5);
    ASSERT_NEAR(measured(*rig, "drawbar_pull_N"), -820.0, kTolerance);
  }
}

TEST(DriveTorque, equals_minus_the_moment_on_the_rim_in_steady_state) {
  const auto rig = placed_rig(steady_options());
  advance(*rig, wrench(Vec3(0, 0, 4600), Vec3(40, -350, 25)), 20);
  EXPECT_NEAR(rig->report(0).drive_torque, 350.0, kTolerance);
  EXPECT_NEAR(rig->report(0).aligning_moment, 25.0, 0.0);
}

TEST(DriveTorque, carries_the_spin_up_of_rim_and_tire_during_the_ramp) {
  rigs::DrawbarRigOptions options = reference_options();
  options.ramp = 0.2;
  const auto rig = placed_rig(options);
  double impulse = 0.0;
  for (int i = 0; i < 6000; ++i) {
    advance(*rig, Wrench{}, 1);
    impulse += rig->report(0).drive_torque * kStep;
  }
  EXPECT_NEAR(impulse, (options.rim_spin_inertia + kTireSpin) * options.angular_speed, 1e-9);
  EXPECT_NEAR(rig->report(0).drive_torque, 0.0, kTolerance);
}

TEST(Toe, wheel_points_and_forces_decompose_in_the_frame_of_travel) {
  rigs::DrawbarRigOptions options = steady_options();
  options.toe_angle = 0.15;
  const auto rig = placed_rig(options);
  const Vec3 axle(-std::sin(0.15), std::cos(0.15), 0.0);
  EXPECT_LT((rig->rim(0).orientation * Vec3::UnitY() - axle).norm(), 1e-15);
  EXPECT_LT((rig->rim(0).angular_velocity - options.angular_speed * axle).norm(), 1e-14);
  const Vec3 force(900.0, -350.0, 4600.0), moment = 12.0 * Vec3::UnitX() - 300.0 * axle;
  advance(*rig, wrench(force, moment), 50);
  const rigs::WheelReport report = rig->report(0);
  EXPECT_NEAR(measured(*rig, "drawbar_pull_N"), 900.0, kTolerance);
  EXPECT_EQ(report.lateral_force, -350.0);
  EXPECT_NEAR(report.drive_torque, -moment.dot(axle), kTolerance);
  EXPECT_LT((rig->rim(0).orientation * Vec3::UnitY() - axle).norm(), 1e-12);
  EXPECT_NEAR(rig->rim(0).position.y(), 0.0, 1e-12);
}

TEST(DrawbarColumns, efficiency_and_motion_resistance_follow_from_the_means_of_a_line) {
  const rigs::DrawbarRigOptions options = steady_options();
  const auto rig = placed_rig(options);
  advance(*rig, wrench(Vec3(1000, 0, 4600), Vec3(0, -500, 0)), 20);
  const std::vector<Column> columns = rig->subjects().front().columns;
  const std::vector<Column> line_columns{column::mean("drawbar_pull_N"), column::mean("spindle_torque_Nm"),
                                         column::mean("speed_m_per_s"), column::mean("spin_rad_per_s")};
  const std::vector<double> line{1000.0, 500.0, 4.0, 8.4};
  std::vector<double> values(columns.size());
  rig->derive(0, {line_columns, line}, values);
  const LineView derived{columns, values};
  EXPECT_NEAR(derived["tractive_efficiency"], 1000.0 * 4.0 / (500.0 * 8.4), 1e-14);
  EXPECT_NEAR(derived["motion_resistance_coefficient"],
              (500.0 / kRadius - 1000.0) / (carried_mass(options) * kStandardGravity), 1e-14);
}

TEST(DrawbarColumns, work_of_the_raw_pull_is_summed_over_the_run) {
  const rigs::DrawbarRigOptions options = steady_options();
  const auto rig = placed_rig(options);
  const double speed = options.angular_speed * kRadius * (1.0 - options.slip);
  advance(*rig, wrench(Vec3(1000, 0, 4600)), 500);
  EXPECT_NEAR(measured(*rig, "pull_work_J"), 1000.0 * speed * 500 * kStep, 1e-7);
}
