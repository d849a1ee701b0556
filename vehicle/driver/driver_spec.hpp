// A driver file (`furrow schema driver` describes it for editors).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/key.hpp"
#include "vehicle/spec/part_keys.hpp"

namespace furrow::vehicle {

/// Points of the plane (m, m), or of a function of time (s, value). Beyond its ends the function is constant.
using DriverPoints = std::vector<std::pair<double, double>>;

namespace keys {
inline constexpr double kMostLength = 1e6;  // of paths, m
inline constexpr Allowed kSeries = allowed::shaped(R"({"allOf": [{"$ref": "#/definitions/series"}]})");
}  // namespace keys

/// Functions of time; empty: not given. Between points, pedals and steering are straight lines; gear and lock are
/// constant.
struct InputSpec {
  DriverPoints throttle, brake;  // 0 to 1
  DriverPoints steering;         // −1 to 1, positive to the left
  DriverPoints gear;             // gear_request, or 1, 2, …
  DriverPoints lock;             // of differentials, 0 or 1
};
void visit_fields(FieldsOf<InputSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.throttle, key("throttle", "-", role::by_hand, keys::kSeries, "0 to 1"));
  visit(s.brake, key("brake", "-", role::by_hand, keys::kSeries, "0 to 1"));
  visit(s.steering, key("steering", "-", role::by_hand, keys::kSeries, "-1 to 1, positive to the left"));
  visit(s.gear, key("gear", "-", role::by_hand, shaped(R"({"$ref": "#/definitions/gear"})"), ""));
  visit(s.lock, key("lock", "-", role::by_hand, shaped(R"({"$ref": "#/definitions/lock"})"), ""));
}

/// speed_control.hpp
struct SpeedSpec {
  DriverPoints target;         // m/s
  double proportional = -1.0;  // throttle per m/s; negative: from the vehicle
  double integral = -1.0;      // throttle per m; negative: from the vehicle
  double hysteresis = 0.05;    // of throttle, between the pedals
  double stop_speed = 0.1;     // below which it stops and holds if the target is 0, m/s; 0: never
};
void visit_fields(FieldsOf<SpeedSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.target, key("target", "m/s", role::by_hand, keys::kSeries.required(),
                      "0 to 100; a CSV file has the columns time_s and speed_m_s"));
  visit(s.proportional, key("proportional", "s/m", from(0).optional(),
                            "Throttle per m/s of error. Without it mass / largest drive force * 1 rad/s."));
  visit(s.integral, key("integral", "1/m", from(0).optional(),
                        "Throttle per m of integrated error. Without it mass / largest drive force * 0.25 (rad/s)^2."));
  visit(s.hysteresis, key("hysteresis", "-", from(0, 1),
                          "Of throttle, by which the demand must change its sign before the foot changes the pedal."));
  visit(s.stop_speed, key("stop_speed", "m/s", from(0, 10),
                          "Below this speed and with target 0 the brakes hold the vehicle. 0: never."));
}

// Shapes of paths (path_shapes.hpp), each from its own origin along its own x axis.

struct StraightPath {
  static constexpr const char* kName = "straight";
  double length = 0.0;  // m
};
void visit_fields(FieldsOf<StraightPath> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.length, needed("length", "m", above(0).to(keys::kMostLength), "Length of the path."));
}

struct CirclePath {
  static constexpr const char* kName = "circle";
  double lead_in = 0.0;  // straight before it, m
  double radius = 0.0;   // m
  double angle_deg = 360.0;
  std::string turn = "left";  // or "right"
};
void visit_fields(FieldsOf<CirclePath> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.lead_in, key("lead_in", "m", from(0, keys::kMostLength), "Straight before the circle."));
  visit(s.radius, needed("radius", "m", above(0).to(keys::kMostLength), "Radius of the circle."));
  visit(s.angle_deg, key("angle_deg", "deg", above(0).to(36000), "Of the whole turn; more than 360 for several laps."));
  visit(s.turn, key("turn", "", words("left right"), "Side to which the path turns."));
}

struct LaneChangePath {
  static constexpr const char* kName = "double_lane_change";
  std::string track = "iso_3888_1";      // a name in kLaneChangeTracks (lane_change.hpp)
  double lead_in = 0.0, lead_out = 0.0;  // straight before and after the track, m
};
void visit_fields(FieldsOf<LaneChangePath> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.track, key("track", "", words("iso_3888_1 iso_3888_2"),
                     "ISO 3888-1 (125 m) or ISO 3888-2 (61 m), centre lines of the lanes for the vehicle's width."));
  visit(s.lead_in, key("lead_in", "m", from(0, keys::kMostLength), "Straight before the track."));
  visit(s.lead_out, key("lead_out", "m", from(0, keys::kMostLength), "Straight after the track."));
}

struct WaypointPath {
  static constexpr const char* kName = "waypoints";
  DriverPoints points;  // (x, y), m
};
void visit_fields(FieldsOf<WaypointPath> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.points,
        key("points", "m", role::by_hand,
            shaped(R"({"anyOf": [{"type": "string"},
                                 {"type": "array", "minItems": 2,
                                  "items": {"type": "array", "items": {"type": "number"},
                                            "minItems": 2, "maxItems": 2}}]})")
                .required(),
            "[x, y], or the name of a CSV file with the columns x_m and y_m. The curve goes through all of them and "
            "turns by at most 120 degrees at each."));
}

// Laws that steer (path_follower.hpp).

struct PurePursuit {
  static constexpr const char* kName = "pure_pursuit";
  double lookahead_time = 0.6;       // s
  double lookahead_distance = -1.0;  // at least, m; below zero: one and a half wheelbases
};
void visit_fields(FieldsOf<PurePursuit> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.lookahead_time,
        key("lookahead_time", "s", from(0, 100), "Times the speed it is the distance to look ahead."));
  visit(s.lookahead_distance, key("lookahead_distance", "m", above(0).to(keys::kMostLength).optional(),
                                  "At least. Without it one and a half wheelbases."));
}

struct Stanley {
  static constexpr const char* kName = "stanley";
  double gain = 2.5;        // 1/s
  double soft_speed = 1.0;  // m/s
};
void visit_fields(FieldsOf<Stanley> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.gain, key("gain", "1/s", above(0).to(1e3), "Gain of the cross-track error."));
  visit(s.soft_speed, key("soft_speed", "m/s", above(0).to(100), "Added to the speed."));
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
void visit_fields(FieldsOf<Preview> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.preview_time, key("preview_time", "s", from(0, 100),
                            "Times the speed it is how far ahead the path's curvature is looked at."));
  visit(s.response_time, key("response_time", "s", from(0, 100),
                             "Times the speed it is the distance in which errors of the path decay."));
  visit(s.response_distance, key("response_distance", "m", above(0).to(keys::kMostLength).optional(),
                                 "That distance at least. Without it one and a half wheelbases."));
  visit(s.understeer,
        key("understeer", "rad s²/m", from(-1, 1),
            "Understeer gradient: how much more the wheels must turn per m/s^2 of lateral acceleration."));
  visit(s.side_slip,
        key("side_slip", "rad s²/m", from(0, 1),
            "Slip angle of the rear axle per m/s^2 of lateral acceleration: 1/(g C) for tires whose side force grows "
            "by C times their load per rad; without it C = 7."));
  visit(s.yaw_damping,
        key("yaw_damping", "s", from(0, 10), "Wheel angle against the yaw rate that the path does not ask for."));
}

using SteeringLaw = std::variant<PurePursuit, Stanley, Preview>;

struct PathSteeringSpec {
  static constexpr SchemaName kSchema{
      "steering", "The law that steers along the path, and the rate at which the steering wheel can turn."};
  SteeringLaw law;
  double rate = 1.0;  // largest, of steering, 1/s
};
void visit_fields(FieldsOf<PathSteeringSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.rate, key("rate", "1/s", above(0).to(1e6),
                    "Largest change of steering: at 1 the wheel turns from the middle to its stop in 1 s."));
}

using PathShape = std::variant<StraightPath, CirclePath, LaneChangePath, WaypointPath>;

struct PathSpec {
  PathShape shape;
  double x = 0.0, y = 0.0;   // the path's origin, W, m
  double heading_deg = 0.0;  // of its x axis
  PathSteeringSpec steering;
};
void visit_fields(FieldsOf<PathSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.x, key("x", "m", from(-keys::kMostLength, keys::kMostLength), "x of the path's origin."));
  visit(s.y, key("y", "m", from(-keys::kMostLength, keys::kMostLength), "y of the path's origin."));
  visit(s.heading_deg, key("heading_deg", "deg", from(-360, 360), "Of the path's x axis, about z."));
  visit(s.steering, key("steering", "", role::by_hand, ""));
}

struct DriverSpec {
  InputSpec inputs;
  std::optional<SpeedSpec> speed;  // instead of throttle and brake
  std::optional<PathSpec> path;    // instead of steering
};

}  // namespace furrow::vehicle
