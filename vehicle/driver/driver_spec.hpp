// What a driver file says (driver.schema.json describes it for people and editors).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "vehicle/spec/spec_roles.hpp"

namespace furrow::vehicle {

/// Points of the plane (m, m), or of a function of time (s, value), which stays what it is at its ends beyond them.
using DriverPoints = std::vector<std::pair<double, double>>;

/// Functions of time; one that is empty was not given. Between points pedals and steering are straight lines, and the
/// gear stays.
struct InputSpec {
  DriverPoints throttle, brake;  // 0 to 1
  DriverPoints steering;         // −1 to 1, positive to the left
  DriverPoints gear;             // gear_request, or 1, 2, …
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<InputSpec> auto& s) {
  visit(Field{"throttle", "-", role::key | kReadApart}, s.throttle);
  visit(Field{"brake", "-", role::key | kReadApart}, s.brake);
  visit(Field{"steering", "-", role::key | kReadApart}, s.steering);
  visit(Field{"gear", "-", role::key | kReadApart}, s.gear);
}

/// speed_control.hpp
struct SpeedSpec {
  DriverPoints target;         // m/s
  double proportional = -1.0;  // throttle per m/s; below zero: from the vehicle
  double integral = -1.0;      // throttle per m; below zero: from the vehicle
  double hysteresis = 0.05;    // of throttle, between the pedals
  double stop_speed = 0.1;     // below which it stops and holds, when the target is 0, m/s; 0 for never
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<SpeedSpec> auto& s) {
  visit(Field{"target", "m/s", role::key | kReadApart}, s.target);
  visit(Field{"proportional", "s/m", role::key | kMayMiss}, s.proportional);
  visit(Field{"integral", "1/m", role::key | kMayMiss}, s.integral);
  visit(Field{"hysteresis", "-", role::key | kMayMiss}, s.hysteresis);
  visit(Field{"stop_speed", "m/s", role::key | kMayMiss}, s.stop_speed);
}

// Shapes of paths (path_shapes.hpp), each from its own origin along its own x axis.

struct StraightPath {
  static constexpr const char* kName = "straight";
  double length = 0.0;  // m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<StraightPath> auto& s) {
  visit(Field{"length", "m", role::key}, s.length);
}

struct CirclePath {
  static constexpr const char* kName = "circle";
  double lead_in = 0.0;  // straight before it, m
  double radius = 0.0;   // m
  double angle_deg = 360.0;
  std::string turn = "left";  // or "right"
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<CirclePath> auto& s) {
  visit(Field{"lead_in", "m", role::key | kMayMiss}, s.lead_in);
  visit(Field{"radius", "m", role::key}, s.radius);
  visit(Field{"angle_deg", "deg", role::key | kMayMiss}, s.angle_deg);
  visit(Field{"turn", "", role::key | kMayMiss}, s.turn);
}

struct LaneChangePath {
  static constexpr const char* kName = "double_lane_change";
  std::string track = "iso_3888_1";      // a name in kLaneChangeTracks (lane_change.hpp)
  double lead_in = 0.0, lead_out = 0.0;  // straight before and after the track, m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<LaneChangePath> auto& s) {
  visit(Field{"track", "", role::key | kMayMiss}, s.track);
  visit(Field{"lead_in", "m", role::key | kMayMiss}, s.lead_in);
  visit(Field{"lead_out", "m", role::key | kMayMiss}, s.lead_out);
}

struct WaypointPath {
  static constexpr const char* kName = "waypoints";
  DriverPoints points;  // (x, y), m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<WaypointPath> auto& s) {
  visit(Field{"points", "m", role::key | kReadApart}, s.points);
}

// Laws that steer (path_follower.hpp).

struct PurePursuit {
  static constexpr const char* kName = "pure_pursuit";
  double lookahead_time = 0.6;       // s
  double lookahead_distance = -1.0;  // at least, m; below zero: one and a half wheelbases
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<PurePursuit> auto& s) {
  visit(Field{"lookahead_time", "s", role::key | kMayMiss}, s.lookahead_time);
  visit(Field{"lookahead_distance", "m", role::key | kMayMiss}, s.lookahead_distance);
}

struct Stanley {
  static constexpr const char* kName = "stanley";
  double gain = 2.5;        // 1/s
  double soft_speed = 1.0;  // m/s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<Stanley> auto& s) {
  visit(Field{"gain", "1/s", role::key | kMayMiss}, s.gain);
  visit(Field{"soft_speed", "m/s", role::key | kMayMiss}, s.soft_speed);
}

struct Preview {
  static constexpr const char* kName = "preview";
  double preview_time = 0.35;       // s
  double response_time = 0.6;       // s
  double response_distance = -1.0;  // at least, m; below zero: one and a half wheelbases
  double understeer = 0.0;          // gradient K, rad s²/m
  double side_slip = 0.015;         // gradient S of the rear axle, rad s²/m
  double yaw_damping = 0.1;         // s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<Preview> auto& s) {
  visit(Field{"preview_time", "s", role::key | kMayMiss}, s.preview_time);
  visit(Field{"response_time", "s", role::key | kMayMiss}, s.response_time);
  visit(Field{"response_distance", "m", role::key | kMayMiss}, s.response_distance);
  visit(Field{"understeer", "rad s²/m", role::key | kMayMiss}, s.understeer);
  visit(Field{"side_slip", "rad s²/m", role::key | kMayMiss}, s.side_slip);
  visit(Field{"yaw_damping", "s", role::key | kMayMiss}, s.yaw_damping);
}

using SteeringLaw = std::variant<PurePursuit, Stanley, Preview>;

struct PathSteeringSpec {
  SteeringLaw law;
  double rate = 1.0;  // largest, of steering, 1/s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<PathSteeringSpec> auto& s) {
  visit(Field{"rate", "1/s", role::key | kMayMiss}, s.rate);
}

using PathShape = std::variant<StraightPath, CirclePath, LaneChangePath, WaypointPath>;

struct PathSpec {
  PathShape shape;
  double x = 0.0, y = 0.0;   // the path's origin, W, m
  double heading_deg = 0.0;  // of its x axis
  PathSteeringSpec steering;
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<PathSpec> auto& s) {
  visit(Field{"x", "m", role::key | kMayMiss}, s.x);
  visit(Field{"y", "m", role::key | kMayMiss}, s.y);
  visit(Field{"heading_deg", "deg", role::key | kMayMiss}, s.heading_deg);
  visit(Field{"steering", "", role::key | kReadApart}, s.steering);
}

struct DriverSpec {
  InputSpec inputs;
  std::optional<SpeedSpec> speed;  // instead of throttle and brake
  std::optional<PathSpec> path;    // instead of steering
};

}  // namespace furrow::vehicle
