// The tire's axes on the ground (ISO-W) against their closed forms, and the series' columns in these axes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nodes/output/series_builder.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow {
namespace {

constexpr double kHeight = 0.46, kGround = 0.01, kSpeed = 4.0;  // m, m, m/s

/// A wheel as the drawbar rig holds it: toe about +z, camber about the forward axis, spun by some angle.
RimState wheel(double toe, double camber, double travel, double spin = 0.7) {
  RimState rim;
  rim.position = Vec3(3.0, -0.2, kHeight);
  rim.orientation = Quat(Eigen::AngleAxisd(toe, Vec3::UnitZ())) *
                    Quat(Eigen::AngleAxisd(travel * camber, Vec3::UnitX())) *
                    Quat(Eigen::AngleAxisd(travel * spin, Vec3::UnitY()));
  rim.velocity = Vec3(travel * kSpeed, 0.0, 0.0);
  return rim;
}

void expect_near(const Vec3& value, const Vec3& reference, double tolerance) {
  EXPECT_LT((value - reference).norm(), tolerance) << value.transpose() << " is not " << reference.transpose();
}

TEST(WheelAxes, upright_straight_wheel_has_the_world_s_axes_under_its_centre) {
  const tire::WheelAxes w = tire::wheel_axes(wheel(0.0, 0.0, 1.0), Vec3::UnitX(), kGround);
  expect_near(w.x, Vec3::UnitX(), 1e-15);
  expect_near(w.y, Vec3::UnitY(), 1e-15);
  expect_near(w.origin, Vec3(3.0, -0.2, kGround), 1e-15);
  EXPECT_NEAR(w.loaded_radius, kHeight - kGround, 1e-15);
  EXPECT_NEAR(w.slip_angle, 0.0, 1e-15);
  EXPECT_NEAR(w.camber_angle, 0.0, 1e-15);
}

TEST(WheelAxes, straight_travel_has_the_toe_angle_as_slip_angle_and_keeps_the_camber) {
  for (const double travel : {1.0, -1.0})
    for (const double toe : {-0.14, 0.0, 0.3})
      for (const double camber : {-0.2, 0.0, 0.087}) {
        const tire::WheelAxes w = tire::wheel_axes(wheel(toe, camber, travel), Vec3(travel, 0, 0), kGround);
        EXPECT_NEAR(w.slip_angle, -toe, 1e-15);  // the wheel points left, so it moves to its right
        EXPECT_NEAR(w.camber_angle, camber, 1e-15);
        expect_near(w.x, travel * Vec3(std::cos(toe), std::sin(toe), 0.0), 1e-15);
        EXPECT_NEAR(w.loaded_radius, (kHeight - kGround) / std::cos(camber), 1e-15);
        EXPECT_NEAR(w.origin.z(), kGround, 1e-15);
        // A top that leans to the right (−y) puts the contact centre to the left of the wheel's centre.
        EXPECT_NEAR((w.origin - wheel(toe, camber, travel).position).dot(w.y), (kHeight - kGround) * std::tan(camber),
                    1e-15);
      }
}

TEST(WheelAxes, forces_turn_by_the_toe_angle) {
  const double toe = 0.25, c = std::cos(toe), s = std::sin(toe);
  const tire::WheelAxes w = tire::wheel_axes(wheel(toe, 0.0, 1.0), Vec3::UnitX(), kGround);
  expect_near(w.turn(Vec3(100.0, 30.0, 4600.0)), Vec3(100.0 * c + 30.0 * s, -100.0 * s + 30.0 * c, 4600.0), 1e-12);
}

TEST(WheelAxes, moment_about_the_contact_centre_is_the_spindles_less_the_arm_times_the_force) {
  // Upright: M_C = (M_x + ρ F_y, M_y − ρ F_x, M_z) with F, M on the rim by the tire are −(those on the tire); here F
  // and M act on the tire, moments about the wheel centre r: M_C = M_r + (r − C) × F, r − C = ρ (0, −sin γ, cos γ).
  const Vec3 force(250.0, -900.0, 4600.0), moment(40.0, -95.0, 18.0);
  for (const double camber : {0.0, 0.1, -0.2}) {
    const RimState rim = wheel(0.0, camber, 1.0);
    const tire::WheelAxes w = tire::wheel_axes(rim, Vec3::UnitX(), kGround);
    const double rho = w.loaded_radius, c = std::cos(camber), s = std::sin(camber);
    const Wrench at_ground = w.wrench(force, moment, rim.position);
    expect_near(at_ground.force, force, 1e-12);
    expect_near(at_ground.moment, moment + rho * Vec3(-s * force.z() - c * force.y(), c * force.x(), s * force.x()),
                1e-12);
    // About the spin axis: M_C · a = M_r · a + ρ F_x.
    const Vec3 axle(0.0, c, s);
    EXPECT_NEAR(at_ground.moment.dot(axle), moment.dot(axle) + rho * force.x(), 1e-11);
  }
}

TEST(WheelAxes, a_force_through_the_contact_centre_has_no_moment_there) {
  const RimState rim = wheel(0.2, 0.1, -1.0);
  const tire::WheelAxes w = tire::wheel_axes(rim, -Vec3::UnitX(), kGround);
  const Vec3 force(-80.0, 400.0, 3000.0);
  const Wrench at_ground = w.wrench(force, w.origin.cross(force), Vec3::Zero());
  EXPECT_LT(at_ground.moment.norm(), 1e-11);
  EXPECT_NEAR(at_ground.force.norm(), force.norm(), 1e-11);
}

TEST(WheelAxes, half_a_turn_of_everything_changes_nothing) {
  const Vec3 force(-80.0, 400.0, 3000.0), moment(7.0, -30.0, 11.0);
  const Mat3 half = Vec3(-1.0, -1.0, 1.0).asDiagonal();
  const RimState there = wheel(0.2, 0.1, 1.0);
  RimState back = wheel(0.2, 0.1, -1.0);
  back.position = half * there.position;
  const tire::WheelAxes a = tire::wheel_axes(there, Vec3::UnitX(), kGround),
                        b = tire::wheel_axes(back, -Vec3::UnitX(), kGround);
  EXPECT_NEAR(a.slip_angle, b.slip_angle, 1e-15);
  EXPECT_NEAR(a.camber_angle, b.camber_angle, 1e-15);
  const Wrench wa = a.wrench(force, moment, Vec3::Zero()), wb = b.wrench(half * force, half * moment, Vec3::Zero());
  expect_near(wa.force, wb.force, 1e-11);
  expect_near(wa.moment, wb.moment, 1e-10);
}

TEST(SeriesBuilder, columns_in_the_tires_axes_are_those_of_the_middle_of_the_interval) {
  const double step = 1e-3, toe = -0.1, radius = 0.47;
  output::SeriesBuilder builder(radius, 0.0, step);
  const Vec3 force(-60.0, 700.0, 4500.0);
  output::StepReports r;
  for (int n = 1; n <= 3; ++n) {
    r.time = n * step;
    r.rim = wheel(toe, 0.0, 1.0);
    r.rim.position = Vec3(kSpeed * r.time, 0.0, 0.46);
    r.tire.lowest_point = -1e-4;
    r.wheel.speed = kSpeed;
    r.wheel.spin = 8.4;
    r.wheel.drive_torque = 500.0;
    r.wheel.carried_mass = 470.0;
    // A force 30 mm behind the point under the axle: pneumatic trail.
    r.tire.contact.force = force;
    r.tire.contact.moment = Vec3(-0.03 * std::cos(toe), -0.03 * std::sin(toe), -0.46 - 1e-4).cross(force);
    // The terrain's later forces, at another place, do not count.
    r.contact.force = 2.0 * force;
    builder.add(r);
    if (n == 1) builder.take();  // it has no predecessor, so its middle is not known
  }
  const output::WheelRow row = builder.take();
  const double c = std::cos(toe), s = std::sin(toe);
  expect_near(row.iso_force, Vec3(c * force.x() + s * force.y(), -s * force.x() + c * force.y(), force.z()), 1e-11);
  EXPECT_NEAR(row.iso_moment.z(), -0.03 * row.iso_force.y(), 1e-10);  // trail t: M_z = −t F_y
  EXPECT_NEAR(row.iso_moment.y(), 0.03 * force.z(), 1e-10);
  EXPECT_NEAR(row.iso_moment.x(), 0.0, 1e-10);
  EXPECT_NEAR(row.slip_angle, -toe, 1e-15);
  EXPECT_NEAR(row.loaded_radius, 0.46 + 1e-4, 1e-15);
  EXPECT_NEAR(row.effective_rolling_radius, kSpeed * c / 8.4, 1e-14);
}

/// On a road that has climbed by 2 m the contact centre is under the wheel, not at the height of the start.
TEST(SeriesBuilder, columns_in_the_tires_axes_count_from_the_tires_lowest_point_on_uneven_ground) {
  output::SeriesBuilder builder(0.47, 0.0, 1e-3, false);
  output::StepReports r;
  for (int n = 1; n <= 2; ++n) {
    r.time = n * 1e-3;
    r.rim = wheel(0.0, 0.0, 1.0);
    r.rim.position = Vec3(kSpeed * r.time, 0.0, 2.45);
    r.tire.lowest_point = 2.0;
    r.tire.contact.force = Vec3(-60.0, 700.0, 4500.0);
    r.tire.contact.moment = Vec3(0.0, 0.0, -0.45).cross(r.tire.contact.force);
    builder.add(r);
  }
  EXPECT_NEAR(builder.last().loaded_radius, 0.45, 1e-12);
  EXPECT_LT(builder.last().iso_moment.norm(), 1e-10);
}

/// (ω R − v)/v.
TEST(SeriesBuilder, slip_ratio_is_that_of_iso_8855) {
  const double radius = 0.5;
  const auto ratio = [&](double slip, double speed, double spin) {
    output::SeriesBuilder builder(radius, 0.0, 1e-3);
    output::StepReports r;
    r.time = 1e-3;
    r.rim = wheel(0.0, 0.0, 1.0);
    r.wheel.slip = slip;
    r.wheel.speed = speed;
    r.wheel.spin = spin;
    builder.add(r);
    return builder.take().slip_ratio;
  };
  EXPECT_NEAR(ratio(0.2, 8.0, 20.0), 0.25, 1e-15);
  EXPECT_NEAR(ratio(-0.25, 10.0, 16.0), -0.2, 1e-15);
  EXPECT_NEAR(ratio(0.2, -8.0, -20.0), 0.25, 1e-15) << "backwards";
  EXPECT_EQ(ratio(-1e6, 10.0, 0.0), -1.0) << "locked";
  EXPECT_EQ(ratio(1.0, 0.0, 20.0), 1e6) << "spins on the spot";
  EXPECT_EQ(ratio(0.0, 1e-4, 0.0), 0.0) << "the rig says that it is at rest";
}

}  // namespace
}  // namespace furrow
