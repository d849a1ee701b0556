// Kinematics of the suspensions. The chassis is held, wheels are lifted and steered, and their motion is given in the
// chassis' frame. Derivatives d/dz are exact, from the constraints' Jacobian.
//
//   roll centre      height above the ground of the point about which the body rolls, y_c dy_c/dz for opposite travel
//   brake slope      dx_c/dz of the contact point with the wheel locked to its carrier; positive if the braking force
//                    opposes the load transfer: compression in front, rebound behind
//   anti-dive        brake slope × share of the braking × wheelbase / height of the centre of mass: this axle's share
//                    of the force that holds the body level
//   motion ratio     −d(length)/dz of spring or shock absorber
//   wheel rate       d/dz of the spring's force at the wheel
//   Ackermann        (δ_i − δ_o)/(δ_i − δ_a), with cot δ_a = cot δ_i + track/wheelbase: 1 if both wheels roll about
//                    one point on the line of the unsteered axles
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/progress_call.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

/// One wheel in one posture; NaN if a quantity does not exist.
struct KinematicsRow {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string motion;     // parallel, opposite or steering
  std::string wheel;      // "front left"
  double steering = 0.0;  // −1 to 1, left positive
  double travel = kNone;  // of the wheel's centre, upward, m
  double camber = kNone, toe = kNone, steer = kNone, caster = kNone, kingpin = kNone;  // rad
  double scrub = kNone;        // contact point outside of the steering axis at the ground, m
  double trail = kNone;        // contact point behind it, m
  double half_track = kNone;   // |y| of the contact point, m
  double wheel_x = kNone;      // of the wheel's centre, m
  double roll_center = kNone;  // above the ground, m
  double brake_slope = kNone, anti_dive = kNone;
  double spring_length = kNone, shock_length = kNone;  // m
  double spring_ratio = kNone, shock_ratio = kNone;
  double wheel_rate = kNone;  // N/m
  double ackermann = kNone;
};
void visit_fields(FieldsOf<KinematicsRow> auto& s, auto&& visit) {
  visit(s.motion, Field{"motion", ""});
  visit(s.wheel, Field{"wheel", ""});
  visit(s.steering, Field{"steering"});
  visit(s.travel, Field{"travel", "m"});
  visit(s.camber, Field{"camber", "rad"});
  visit(s.toe, Field{"toe", "rad"});
  visit(s.steer, Field{"steer", "rad"});
  visit(s.caster, Field{"caster", "rad"});
  visit(s.kingpin, Field{"kingpin", "rad"});
  visit(s.scrub, Field{"scrub", "m"});
  visit(s.trail, Field{"trail", "m"});
  visit(s.half_track, Field{"half_track", "m"});
  visit(s.wheel_x, Field{"wheel_x", "m"});
  visit(s.roll_center, Field{"roll_center", "m"});
  visit(s.brake_slope, Field{"brake_slope"});
  visit(s.anti_dive, Field{"anti_dive"});
  visit(s.spring_length, Field{"spring_length", "m"});
  visit(s.shock_length, Field{"shock_length", "m"});
  visit(s.spring_ratio, Field{"spring_ratio"});
  visit(s.shock_ratio, Field{"shock_ratio"});
  visit(s.wheel_rate, Field{"wheel_rate", "N/m"});
  visit(s.ackermann, Field{"ackermann"});
}

struct KinematicsOptions {
  double travel = 0.1;  // up and down from the drawn position, m
  int points = 21;      // of each motion
};

/// All three motions of all axles that can make them, wheel by wheel.
/// @param radii of the tires under load, m, one for each wheel
/// @param progress may be empty; not called for work of a few seconds
/// @throws Error(physics) naming the wheel whose suspension cannot follow
std::vector<KinematicsRow> kinematics(const VehicleSpec& spec, std::span<const double> radii,
                                      const KinematicsOptions& options = {}, const ProgressCall& progress = {});

/// Of each wheel at its travel: c/(2 √(k m)) with the wheel rate k, the shock absorber's coefficient at small speeds,
/// mean of both directions, moved to the wheel, c, and the mass m that the spring carries there [Gillespie 1992,
/// Fundamentals of Vehicle Dynamics, chapter 5]. Not a number without spring or shock absorber.
/// @param travel of each wheel, upward from the drawn position, m
std::vector<double> damping_ratios(const VehicleSpec& spec, std::span<const double> radii,
                                   std::span<const double> travel);

/// Every steered axle must reach both ends of its steering, step by step from straight ahead, as drawn.
/// @throws Error(bad_input) naming the key that says where the ends are
void check_locks(const VehicleSpec& spec, std::span<const double> radii, const ProgressCall& progress = {});

/// The key that sets a steering's end on the left.
const char* end_key(const SteeringSpec& steering);

/// Mean angle of each axle's wheels at full steering to the left, positive left, rad; 0 for an unsteered axle.
/// @pre check_locks() passed
std::vector<double> full_steering(const VehicleSpec& spec, std::span<const double> radii);

/// CSV text: names with units, then one line for each row. A field is empty if its quantity does not exist.
std::string kinematics_csv(std::span<const KinematicsRow> rows);

}  // namespace furrow::vehicle
