// Kinematics of the suspensions against an independent solution, and against geometry by hand.
#include "vehicle/analysis/kinematics.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "protocol/core/error.hpp"
#include "tests/vehicle/double_wishbone.hpp"
#include "tests/vehicle/shipped.hpp"
#include "tests/verification/record.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::KinematicsRow;

namespace {

constexpr double kRadius = 0.4573;  // of the loaded tire, m
constexpr double kTolerance = 1e-6;

/// The lowest point of a wheel's middle circle.
Vec3 touching(const DoubleWishbone::Points& p) {
  const Vec3 a = (p[DoubleWishbone::kAxle] - p[DoubleWishbone::kCenter]).normalized();
  return p[DoubleWishbone::kCenter] + kRadius * (a.z() * a - Vec3::UnitZ()).normalized();
}

/// Motion of the tie rods' inner ends: arm and idler of equal length make a parallelogram.
Vec3 link_motion(double steering) {
  const double angle = -30.0 * steering * std::numbers::pi / 180.0;
  const Quat pitch(Eigen::AngleAxisd(18.5 * std::numbers::pi / 180.0, Vec3::UnitY()));
  return pitch * Vec3(0.129 * (std::cos(angle) - 1.0), 0.129 * std::sin(angle), 0.0);
}

struct Expected {
  const DoubleWishbone& side;
  double outward;
  DoubleWishbone::Points p;

  void compare(const KinematicsRow& row, verification::Worst& worst) const {
    const Vec3 a = (p[DoubleWishbone::kAxle] - p[DoubleWishbone::kCenter]).normalized();
    const Vec3 u = (p[DoubleWishbone::kUpper] - p[DoubleWishbone::kLower]).normalized();
    const Vec3 contact = touching(p);
    const Vec3 low = p[DoubleWishbone::kLower] + (contact.z() - p[DoubleWishbone::kLower].z()) / u.z() * u;
    worst.add(row.camber, std::asin(-outward * a.z()), 1.0, row.wheel + "'s camber");
    worst.add(row.toe, outward * std::atan2(a.x(), a.y()), 1.0, row.wheel + "'s toe");
    worst.add(row.steer, std::atan2(-a.x(), a.y()), 1.0, row.wheel + "'s steer");
    worst.add(row.caster, std::atan2(-u.x(), u.z()), 1.0, row.wheel + "'s caster");
    worst.add(row.kingpin, std::atan2(-outward * u.y(), u.z()), 1.0, row.wheel + "'s kingpin");
    worst.add(row.half_track, std::abs(contact.y()), 1.0, row.wheel + "'s half track");
    worst.add(row.wheel_x, p[DoubleWishbone::kCenter].x(), 1.0, row.wheel + "'s wheel x");
    worst.add(row.scrub, outward * (contact.y() - low.y()), 1.0, row.wheel + "'s scrub");
    worst.add(row.trail, low.x() - contact.x(), 1.0, row.wheel + "'s trail");
    worst.add(row.spring_length, side.spring_length(p), 1.0, row.wheel + "'s spring length");
  }
};

std::vector<KinematicsRow> sweep(const vehicle::VehicleSpec& spec, double radius, double travel = 0.08,
                                 int points = 5) {
  const std::vector<double> radii(2 * spec.axles.size(), radius);
  return vehicle::kinematics(spec, radii, {travel, points});
}

}  // namespace

TEST(Kinematics, double_wishbones_match_an_independent_solution_of_distances) {
  const vehicle::VehicleSpec spec = shipped("hmmwv.json");
  const std::string name = "double wishbones of the HMMWV, travel of 80 mm and steering";
  verification::Worst places(name, "camber, toe, caster, kingpin, scrub, trail, track, spring, rad and m", kTolerance,
                             "solution of distances");
  verification::Worst slopes(name, "roll centre, anti-dive, motion ratio, m and 1", kTolerance,
                             "differences of the solution of distances");
  int compared = 0;
  for (const KinematicsRow& row : sweep(spec, kRadius)) {
    const int axle = row.wheel.starts_with("front") ? 0 : 1, k = row.wheel.ends_with("left") ? 0 : 1;
    const auto& suspension = std::get<vehicle::DoubleWishboneSpec>(spec.axles[axle].corners[k].suspension);
    const DoubleWishbone side(suspension);
    const Vec3 rod = axle == 0 ? link_motion(row.steering) : Vec3(Vec3::Zero());
    const Expected expected{side, k == 0 ? 1.0 : -1.0, side.solve(row.travel, rod)};
    expected.compare(row, places);
    ++compared;
    // Slopes by differences of the independent solution.
    const double e = 1e-5;
    const auto up = side.solve(row.travel + e, rod), down = side.solve(row.travel - e, rod);
    const Mat3 axes = DoubleWishbone::upright_axes(expected.p);
    const Vec3 local = axes.transpose() * (touching(expected.p) - expected.p[DoubleWishbone::kLower]);
    const auto moved = [&](const DoubleWishbone::Points& p) {
      return Vec3(p[DoubleWishbone::kLower] + DoubleWishbone::upright_axes(p) * local);
    };
    const Vec3 slope = (moved(up) - moved(down)) / (2.0 * e);
    slopes.add(row.roll_center, touching(expected.p).y() * slope.y(), 1.0, row.wheel + "'s roll centre");
    slopes.add(row.brake_slope, (axle == 0 ? 1.0 : -1.0) * slope.x(), 1.0, row.wheel + "'s brake slope");
    slopes.add(row.spring_ratio, -(side.spring_length(up) - side.spring_length(down)) / (2.0 * e), 1.0,
               row.wheel + "'s spring ratio");
  }
  EXPECT_EQ(compared, 5 * 2 * (3 + 2));
}

TEST(Kinematics, wheel_rates_are_the_slope_of_the_springs_force_at_the_wheel) {
  const vehicle::VehicleSpec spec = shipped("hmmwv_tr.json");
  for (const KinematicsRow& row : sweep(spec, kRadius, 0.08, 5)) {
    if (row.motion != "parallel") continue;
    const int axle = row.wheel.starts_with("front") ? 0 : 1, k = row.wheel.ends_with("left") ? 0 : 1;
    const auto& suspension = std::get<vehicle::DoubleWishboneSpec>(spec.axles[axle].corners[k].suspension);
    const DoubleWishbone side(suspension);
    // U = k/2 (L₀ − L)²; the wheel's force is U′ and its rate U″.
    const auto energy = [&](double travel) {
      const double d = suspension.spring->free_length - side.spring_length(side.solve(travel));
      return 0.5 * *suspension.spring->rate * d * d;
    };
    const double e = 2e-3;
    const double rate = (energy(row.travel + e) - 2.0 * energy(row.travel) + energy(row.travel - e)) / (e * e);
    EXPECT_NEAR(row.wheel_rate, rate, 1e-3 * rate) << row.wheel << " at " << row.travel;
  }
}

TEST(Kinematics, positive_steering_turns_the_wheels_to_the_left_and_the_inner_one_more) {
  for (const char* name : {"hmmwv.json", "buggy.json"}) {
    double left = 0.0, right = 0.0, ackermann = 0.0;
    for (const KinematicsRow& row : sweep(shipped(name), 0.4, 0.05, 3)) {
      if (row.motion != "steering" || row.steering != 1.0) continue;
      (row.wheel == "front left" ? left : right) = row.steer;
      ackermann = row.ackermann;
    }
    EXPECT_GT(left, 0.2) << name;
    EXPECT_GT(right, 0.2) << name;
    EXPECT_EQ(left > right, ackermann > 0.0) << name;
    EXPECT_LT(std::abs(ackermann), 2.0) << name;
  }
}

TEST(Kinematics, axles_are_front_or_rear_wherever_the_origin_of_the_file_is) {
  const auto anti_dive = [](double shift) {
    nlohmann::json text = shipped_text("buggy.json");
    text["chassis"]["center_of_mass"][0] = text["chassis"]["center_of_mass"][0].get<double>() + shift;
    for (nlohmann::json& axle : text["axles"]) axle["origin"][0] = axle["origin"][0].get<double>() + shift;
    std::array<double, 2> found{};
    for (const KinematicsRow& row : sweep(vehicle::read_vehicle(text, "buggy.json"), 0.4, 0.05, 3))
      if (row.motion == "parallel" && std::abs(row.travel) < 1e-6)
        found[row.wheel.starts_with("front") ? 0 : 1] = row.anti_dive;
    return found;
  };
  const auto [front, rear] = anti_dive(0.0);
  EXPECT_GT(front, 1e-3);
  EXPECT_LT(rear, -1e-2);
  for (const double shift : {-1.9, -1.2, 1.2, 1.7}) {
    EXPECT_NEAR(anti_dive(shift)[0], front, 1e-9) << shift;
    EXPECT_NEAR(anti_dive(shift)[1], rear, 1e-9) << shift;
  }
}

TEST(Kinematics, behind_the_turning_line_the_outer_wheel_steers_to_the_other_side) {
  nlohmann::json text = shipped_text("buggy.json");
  std::swap(text["axles"][0]["origin"], text["axles"][1]["origin"]);  // the steered one is the last
  double left = 0.0, right = 0.0, ackermann = 0.0;
  for (const KinematicsRow& row : sweep(vehicle::read_vehicle(text, "buggy.json"), 0.4, 0.05, 3)) {
    if (row.motion != "steering" || row.steering != 1.0) continue;
    (row.wheel.ends_with("left") ? left : right) = row.steer;
    ackermann = row.ackermann;
  }
  ASSERT_GT(left, right);
  ASSERT_GT(right, 0.2);  // the vehicle turns right, about a point on that side: the right wheel is the inner one
  const double ideal = std::atan(1.0 / (1.0 / std::tan(right) + 2.0 * 0.7 / 2.4));
  EXPECT_LT(ackermann, 0.0);
  EXPECT_NEAR(ackermann, (right - left) / (right - ideal), 0.1 * std::abs(ackermann));
}

// If a steering demands more than its linkage allows, the message contains demand, limit and the input at the limit.
TEST(Kinematics, a_rack_beyond_its_linkage_is_told_with_travel_limit_and_demand) {
  vehicle::VehicleSpec car = shipped("buggy.json");
  std::get<vehicle::RackSpec>(*car.axles[0].steering).left_travel = -0.5;
  const std::vector<double> radii(4, 0.3);
  expect_refused(ExitCode::bad_input,
                 {"key 'axles[0].steering.left_travel': is -0.5 m, the travel of the rack that full steering "
                  "asks for, expected at most 0.1 m in magnitude: steering -1 asks for 0.5 m, but the linkage "
                  "of axle 'front' ends at 0.1 m, steering -0.2"},
                 [&] { vehicle::check_locks(car, radii); });
}

// Trailing arm by hand: the centre moves on a circle about the pivot; camber and toe do not change.
TEST(Kinematics, a_trailing_arm_moves_on_its_circle) {
  const vehicle::VehicleSpec spec = shipped("rover.json");
  for (const KinematicsRow& row : sweep(spec, 0.058, 0.02, 5)) {
    if (row.wheel != "front left" || row.motion != "parallel") continue;
    const double z = -0.03 + row.travel;  // above the pivot, which lies 0.10 m behind
    EXPECT_NEAR(row.wheel_x, 0.12 + std::sqrt(0.10 * 0.10 + 0.03 * 0.03 - z * z), 1e-12);
    EXPECT_NEAR(row.camber, 0.0, 1e-12);
    EXPECT_NEAR(row.toe, 0.0, 1e-12);
  }
}

// A rigid axle that rolls about a panhard rod on its middle: the roll centre is the intersection of the rod with the
// middle plane.
TEST(Kinematics, the_roll_center_of_a_rigid_axle_lies_at_its_panhard_rod) {
  for (const KinematicsRow& row : sweep(shipped("buggy.json"), 0.3, 0.05, 3)) {
    if (!row.wheel.starts_with("rear") || row.motion != "opposite" || std::abs(row.travel) > 1e-9) continue;
    EXPECT_NEAR(row.roll_center, 0.3, 0.01) << row.wheel;
    EXPECT_NEAR(row.camber, 0.0, 1e-9);
  }
}

TEST(Kinematics, the_table_has_one_column_for_each_field_and_leaves_out_what_does_not_exist) {
  const auto rows = sweep(shipped("rover.json"), 0.058, 0.01, 2);
  const std::string csv = vehicle::kinematics_csv(rows);
  EXPECT_TRUE(csv.starts_with("motion,wheel,steering,travel_m,camber_rad,")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(rows.size()) + 1);
  EXPECT_EQ(csv.find("nan"), std::string::npos);
}
