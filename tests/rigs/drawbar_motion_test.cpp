// Motions of the rig: imposed ones exactly, the vertical one by Newton's law.
#include <gtest/gtest.h>

#include <cmath>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

TEST(Place, rim_stands_at_height_and_start_with_the_imposed_velocities) {
  rigs::DrawbarRigOptions options = steady_options();
  options.start = 1.7;
  auto rig = placed_rig(options);
  const double speed = options.angular_speed * kRadius * (1.0 - options.slip);
  EXPECT_LT((rig->rim(0).position - Vec3(1.7, 0, 0.5)).norm(), 1e-15);
  EXPECT_LT((rig->rim(0).velocity - Vec3(speed, 0, 0)).norm(), 1e-15);
  EXPECT_LT((rig->rim(0).angular_velocity - Vec3(0, 8.56, 0)).norm(), 1e-14);
  EXPECT_NEAR(rig->report(0).slip, 0.3, 1e-14);
  options.ramp = 0.15;
  rig = placed_rig(options);
  EXPECT_EQ(rig->rim(0).velocity.norm(), 0.0);
  EXPECT_EQ(rig->rim(0).angular_velocity.norm(), 0.0);
}

TEST(Modes, slip_is_what_was_asked_for_during_and_after_the_ramp) {
  for (const char* mode : {"fixed_angular_speed", "fixed_speed"}) {
    for (const double slip : {-0.2, 0.0, 0.3, 0.6}) {
      rigs::DrawbarRigOptions options = reference_options();
      options.mode = mode;
      options.slip = slip;
      options.ramp = 0.05;
      const auto rig = placed_rig(options);
      for (int i = 1; i <= 2000; ++i) {
        advance(*rig, Wrench{}, 1);
        if (i % 100 == 0) {
          ASSERT_NEAR(rig->report(0).slip, slip, 1e-7) << mode << i;
        }
      }
      const rigs::WheelReport report = rig->report(0);
      if (std::string(mode) == "fixed_speed") {
        EXPECT_NEAR(report.speed, options.speed, 1e-9);
        EXPECT_NEAR(rig->rim(0).angular_velocity.y(), options.speed / (kRadius * (1.0 - slip)), 1e-12);
      } else {
        EXPECT_NEAR(report.spin, options.angular_speed, 1e-9);
        EXPECT_NEAR(rig->rim(0).velocity.x(), options.angular_speed * kRadius * (1.0 - slip), 1e-12);
      }
    }
  }
}

TEST(Modes, imposed_position_and_angle_are_followed_without_drift) {
  rigs::DrawbarRigOptions options = reference_options();
  const auto rig = placed_rig(options);
  advance(*rig, wrench(Vec3(1500, 60, carried_mass(options) * kStandardGravity), Vec3(30, -500, 20)),
          25000);                                // 1 s
  const double time = 1.0 - 0.5 * options.ramp;  // the ramp's integral
  EXPECT_NEAR(rig->report(0).axle_position, options.angular_speed * kRadius * 0.7 * time, 1e-11);
  const Quat turned(Eigen::AngleAxisd(options.angular_speed * time, Vec3::UnitY()));
  EXPECT_LT(rig->rim(0).orientation.angularDistance(turned), 1e-9);
  EXPECT_LT(rig->report(0).joint_drift, 1e-12);
}

TEST(FreeRolling, moment_spins_rim_and_tire_up_with_their_sum_of_inertia) {
  rigs::DrawbarRigOptions options = steady_options();
  options.mode = "free_rolling";
  const auto rig = placed_rig(options);
  const double start = options.speed / kRadius, moment = 6.0;
  EXPECT_NEAR(rig->rim(0).angular_velocity.y(), start, 1e-14);
  advance(*rig, wrench(Vec3(-80.0, 0, 4600), Vec3(0, moment, 0)), 2500);
  const double expected = start + moment * 0.1 / (options.rim_spin_inertia + kTireSpin);
  EXPECT_NEAR(rig->rim(0).angular_velocity.y(), expected, 1e-10);
  EXPECT_EQ(rig->report(0).drive_torque, 0.0);
  EXPECT_NEAR(measured(*rig, "drawbar_pull_N"), -80.0, 1e-6);
}

TEST(FreeRolling, starts_at_rest_under_a_ramp_and_reports_a_bounded_slip) {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = "free_rolling";
  const auto rig = placed_rig(options);
  advance(*rig, Wrench{}, 500);
  EXPECT_EQ(rig->rim(0).angular_velocity.norm(), 0.0);
  EXPECT_TRUE(std::isfinite(rig->report(0).slip));
}

TEST(Vertical, weight_in_balance_keeps_the_height) {
  const rigs::DrawbarRigOptions options = steady_options();
  const auto rig = placed_rig(options);
  advance(*rig, wrench(Vec3(0, 0, carried_mass(options) * kStandardGravity)), 5000);
  EXPECT_NEAR(rig->report(0).axle_height, 0.5, 1e-12);
  EXPECT_NEAR(rig->report(0).carried_mass, 469.8, 1e-12);
}

TEST(Vertical, free_fall_and_newtons_law) {
  const rigs::DrawbarRigOptions options = steady_options();
  const double mass = carried_mass(options);
  for (const double force : {0.0, 7000.0}) {
    const auto rig = placed_rig(options);
    advance(*rig, wrench(Vec3(500, 0, force), Vec3(0, -100, 0)), 2500);
    const double acceleration = force / mass - kStandardGravity, t = 0.1;
    EXPECT_NEAR(rig->report(0).axle_height, 0.5 + 0.5 * acceleration * t * t, 1e-11);
    EXPECT_NEAR(rig->report(0).vertical_speed, acceleration * t, 1e-11);
    EXPECT_NEAR(rig->report(0).vertical_momentum, mass * acceleration * t, 1e-8);
  }
}

TEST(Vertical, touchdown_damper_acts_for_its_time_only) {
  rigs::DrawbarRigOptions options = steady_options();
  options.touchdown_damping = 12e3;
  options.touchdown_time = 0.04;
  const auto rig = placed_rig(options);
  const double mass = carried_mass(options), z = 0.5 * kStep * options.touchdown_damping / mass;
  double v = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const bool active = i < 1000;
    // Implicit midpoint: v₁ = v½ (1 − z) − g h/2, v½ = (v₀ − g h/2)/(1 + z).
    const double c = active ? z : 0.0, half = (v - 0.5 * kStep * kStandardGravity) / (1.0 + c);
    v = half * (1.0 - c) - 0.5 * kStep * kStandardGravity;
    advance(*rig, Wrench{}, 1);
    ASSERT_NEAR(rig->report(0).vertical_speed, v, 1e-11) << i;
    ASSERT_NEAR(measured(*rig, "damper_force_N"), active ? -options.touchdown_damping * half : 0.0, 1e-6) << i;
  }
}

TEST(Travel, mirrored_travel_mirrors_everything) {
  rigs::DrawbarRigOptions options = reference_options();
  options.toe_angle = 0.1;
  const auto forward = placed_rig(options);
  options.travel_sign = -1.0;
  options.toe_angle = -0.1;
  const auto backward = placed_rig(options);
  EXPECT_EQ(backward->heading(0), Vec3(-1, 0, 0));
  // Mirror in the y–z plane: forces change x, moments (axial) change y and z.
  advance(*forward, wrench(Vec3(900, 120, 4700), Vec3(15, -250, 8)), 5000);
  advance(*backward, wrench(Vec3(-900, 120, 4700), Vec3(15, 250, -8)), 5000);
  const rigs::WheelReport f = forward->report(0), b = backward->report(0);
  EXPECT_NEAR(measured(*forward, "drawbar_pull_N"), measured(*backward, "drawbar_pull_N"), 1e-6);
  EXPECT_NEAR(measured(*forward, "drawbar_pull_raw_N"), measured(*backward, "drawbar_pull_raw_N"), 1e-6);
  EXPECT_NEAR(f.drive_torque, b.drive_torque, 1e-7);
  EXPECT_NEAR(f.lateral_force, -b.lateral_force, 1e-12);  // l is on the other side
  EXPECT_NEAR(f.slip, b.slip, 1e-9);
  EXPECT_NEAR(f.speed, b.speed, 1e-9);
  EXPECT_NEAR(f.spin, b.spin, 1e-9);
  EXPECT_NEAR(f.axle_position, b.axle_position, 1e-12);
  EXPECT_NEAR(f.axle_height, b.axle_height, 1e-12);
  EXPECT_LT(backward->rim(0).velocity.x(), 0.0);
  EXPECT_LT(backward->rim(0).angular_velocity.y(), 0.0);
}

TEST(Travel, lateral_force_is_positive_to_the_left_of_travel) {
  rigs::DrawbarRigOptions options = steady_options();
  options.travel_sign = -1.0;
  const auto rig = placed_rig(options);
  advance(*rig, wrench(Vec3(0, 100, 4600)), 1);
  EXPECT_EQ(rig->report(0).lateral_force, -100.0);
}

TEST(Camber, wheel_leans_about_its_forward_axis_and_keeps_to_it) {
  for (const double travel : {1.0, -1.0}) {
    rigs::DrawbarRigOptions options = steady_options();
    options.travel_sign = travel;
    options.camber_angle = 0.08;
    options.toe_angle = -0.05;
    const auto rig = placed_rig(options);
    const Vec3 forward = travel * Vec3(std::cos(0.05), -std::sin(0.05), 0.0);
    const Vec3 left = std::cos(0.08) * Vec3::UnitZ().cross(forward) + std::sin(0.08) * Vec3::UnitZ();
    EXPECT_LT((rig->rim(0).angular_velocity - options.angular_speed * left).norm(), 1e-14);
    advance(*rig, wrench(Vec3(travel * 900, 350, 4600), Vec3(30, -250, 8)), 5000);
    EXPECT_LT((travel * (rig->rim(0).orientation * Vec3::UnitY()) - left).norm(), 1e-12);
    EXPECT_LT((rig->rim(0).angular_velocity - options.angular_speed * left).norm(), 1e-11);
    EXPECT_LT(rig->report(0).joint_drift, 1e-12);
    EXPECT_NEAR(rig->report(0).spin, options.angular_speed, 1e-9);
    EXPECT_NEAR(rig->report(0).drive_torque, -travel * Vec3(30, -250, 8).dot(travel * left), 1e-6);
  }
}

TEST(Camber, mirrored_camber_and_toe_mirror_everything) {
  rigs::DrawbarRigOptions options = reference_options();
  options.toe_angle = 0.1;
  options.camber_angle = -0.07;
  options.toe_time = 0.05;
  const auto one = placed_rig(options);
  options.toe_angle = -0.1;
  options.camber_angle = 0.07;
  const auto other = placed_rig(options);
  // Mirror in the x–z plane: forces change y, moments (axial) change x and z.
  advance(*one, wrench(Vec3(900, 120, 4700), Vec3(15, -250, 8)), 5000);
  advance(*other, wrench(Vec3(900, -120, 4700), Vec3(-15, -250, -8)), 5000);
  const rigs::WheelReport a = one->report(0), b = other->report(0);
  EXPECT_NEAR(measured(*one, "drawbar_pull_N"), measured(*other, "drawbar_pull_N"), 1e-6);
  EXPECT_NEAR(a.drive_torque, b.drive_torque, 1e-7);
  EXPECT_NEAR(a.lateral_force, -b.lateral_force, 1e-12);
  EXPECT_NEAR(a.spin, b.spin, 1e-9);
  EXPECT_NEAR(a.axle_height, b.axle_height, 1e-12);
  const Vec3 axle = one->rim(0).orientation * Vec3::UnitY(), mirrored = other->rim(0).orientation * Vec3::UnitY();
  EXPECT_LT((axle - Vec3(-mirrored.x(), mirrored.y(), -mirrored.z())).norm(), 1e-12);
}

TEST(Steering, wheel_runs_straight_until_its_time_then_turns_smoothly_to_the_toe_angle) {
  rigs::DrawbarRigOptions options = steady_options();
  options.toe_angle = 0.06;
  options.toe_time = 0.02;
  options.toe_ramp = 0.01;
  const auto rig = placed_rig(options);
  double turned = 0.0;
  for (int i = 1; i <= 1250; ++i) {  // 0.05 s
    advance(*rig, wrench(Vec3(0, 0, 4600), Vec3(0, -100, 0)), 1);
    turned += kStep * rig->rim(0).angular_velocity.z();
    const double time = i * kStep;
    const Vec3 axle = rig->rim(0).orientation * Vec3::UnitY();
    if (time <= 0.02) {
      ASSERT_LT((axle - Vec3::UnitY()).norm(), 1e-12) << time;
    }
    if (time >= 0.03 + kStep) {
      ASSERT_LT((axle - Vec3(-std::sin(0.06), std::cos(0.06), 0.0)).norm(), 1e-9) << time;
      ASSERT_NEAR(rig->rim(0).angular_velocity.z(), 0.0, 1e-9) << time;
    }
  }
  EXPECT_NEAR(turned, 0.06, 1e-6);
  EXPECT_NEAR(rig->report(0).spin, options.angular_speed, 1e-9);
  EXPECT_LT(rig->report(0).joint_drift, 1e-12);
}

/// As in a laboratory, the wheel is lowered and stands still until `move_from`, then moves as it would from t = 0.
TEST(Phases, a_wheel_stands_until_move_from_and_moves_as_from_zero_after_it) {
  rigs::DrawbarRigOptions options = reference_options(), late = options;
  const int wait = 500, moving = 1000;
  late.move_from = wait * kStep;
  const auto rig = placed_rig(options), waiting = placed_rig(late);
  const Wrench weight = wrench(Vec3(0.0, 0.0, 9.81 * carried_mass(options)));
  for (int i = 0; i < wait; ++i) {
    advance(*waiting, weight, 1);
    ASSERT_EQ(waiting->report(0).slip, 0.0) << i;
    ASSERT_NEAR(waiting->report(0).speed, 0.0, 1e-12) << i;
    ASSERT_NEAR(waiting->rim(0).angular_velocity.norm(), 0.0, 1e-12) << i;
  }
  advance(*waiting, weight, moving);
  advance(*rig, weight, moving);
  EXPECT_NEAR(waiting->rim(0).position.x(), rig->rim(0).position.x(), 1e-12);
  EXPECT_NEAR(waiting->report(0).spin, rig->report(0).spin, 1e-9);
  EXPECT_GT(rig->report(0).speed, 0.1);
}

/// m dv/dt = −W − c v from rest: v(t) = −W/c (1 − exp(−c t/m)).
TEST(Phases, the_damper_lets_a_wheel_down_at_load_over_damping) {
  rigs::DrawbarRigOptions options = steady_options();
  options.touchdown_damping = 4e4;
  options.touchdown_time = 1.0;
  const double weight = 9.81 * carried_mass(options);
  const auto rig = placed_rig(options);
  advance(*rig, wrench(Vec3::Zero()), 5000);  // 17 time constants
  EXPECT_NEAR(rig->report(0).vertical_speed, -weight / options.touchdown_damping, 1e-5);
}

TEST(Refusals, bad_options_are_refused) {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = "fast";
  EXPECT_THROW(rigs::make_drawbar_rig(options), Error);
  options = reference_options();
  options.mode = "fixed_speed";
  options.slip = 1.0;
  EXPECT_THROW(rigs::make_drawbar_rig(options), Error);
  options = reference_options();
  options.carrier_mass = -1.0;
  EXPECT_THROW(rigs::make_drawbar_rig(options), Error);
}
