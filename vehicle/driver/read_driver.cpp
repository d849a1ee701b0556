#include "vehicle/driver/read_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include <fmt/format.h>

#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/lane_change.hpp"
#include "vehicle/driver/read_points.hpp"
#include "vehicle/spec/spec_reader.hpp"
#include "vehicle/spec/value_rules.hpp"

namespace furrow::vehicle {
namespace {

constexpr int kFormatVersion = 1;
constexpr double kMostLength = 1e6;      // of paths, m
constexpr double kMostAngle = 36000.0;   // of a circle, degrees
constexpr double kLeastSpacing = 1e-3;   // of waypoints, m
constexpr double kSharpestTurn = 120.0;  // at a waypoint, degrees

constexpr PointRule kThrottle{"time_s", "throttle", 0.0, 1.0, "a number from 0 to 1"};
constexpr PointRule kBrake{"time_s", "brake", 0.0, 1.0, "a number from 0 to 1"};
constexpr PointRule kSteering{"time_s", "steering", -1.0, 1.0, "a number from -1 to 1"};
constexpr PointRule kGear{"time_s",
                          "gear",
                          gear_request::reverse,
                          20.0,
                          "'auto', -1 (reverse), 0 (neutral) or a gear from 1 to 20",
                          "auto",
                          gear_request::automatic,
                          true};
constexpr PointRule kSpeed{"time_s", "speed_m_s", 0.0, 100.0, "a speed from 0 to 100"};
constexpr PointRule kWaypoint{"x_m", "y_m", -kMostLength, kMostLength, "at most 1e6"};

// Keys of each section: what they may be, and what is read apart.

void finish(StraightPath& shape, JsonReader& reader) { check_positive(reader, "length", shape.length, kMostLength); }

void finish(CirclePath& shape, JsonReader& reader) {
  check_positive(reader, "radius", shape.radius, kMostLength);
  check_positive(reader, "angle_deg", shape.angle_deg, kMostAngle);
  check_within(reader, "lead_in", shape.lead_in, 0.0, kMostLength);
  check_known(reader, "turn", shape.turn, {"left", "right"});
}

void finish(LaneChangePath& shape, JsonReader& reader) {
  check_known(reader, "track", shape.track, lane_change_names());
  check_within(reader, "lead_in", shape.lead_in, 0.0, kMostLength);
  check_within(reader, "lead_out", shape.lead_out, 0.0, kMostLength);
}

void finish(WaypointPath& shape, JsonReader& reader) {
  const DriverPoints points = read_points(reader, "points", kWaypoint);
  if (points.size() < 2) reader.fail("points", "has one point, expected two or more");
  const auto chord = [&](std::size_t i) {
    return std::array{points[i + 1].first - points[i].first, points[i + 1].second - points[i].second};
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto [x, y] = chord(i);
    if (std::hypot(x, y) < kLeastSpacing)
      reader.fail("points",
                  fmt::format("has points {} and {} at one place, expected 1 mm between them or more", i + 1, i + 2));
    if (i == 0) continue;
    const auto [a, b] = chord(i - 1);
    const double turn = std::abs(std::atan2(a * y - b * x, a * x + b * y)) * 180.0 / std::numbers::pi;
    if (turn > kSharpestTurn)
      reader.fail("points",
                  fmt::format("turns by {:.0f}° at point {}, expected at most {:.0f}°", turn, i + 1, kSharpestTurn));
  }
  shape.points = points;
}

void finish(PurePursuit& law, JsonReader& reader) {
  check_within(reader, "lookahead_time", law.lookahead_time, 0.0, 100.0);
  if (reader.given("lookahead_distance"))
    check_positive(reader, "lookahead_distance", law.lookahead_distance, kMostLength);
}

void finish(Stanley& law, JsonReader& reader) {
  check_positive(reader, "gain", law.gain, 1e3);
  check_positive(reader, "soft_speed", law.soft_speed, 100.0);
}

void finish(Preview& law, JsonReader& reader) {
  check_within(reader, "preview_time", law.preview_time, 0.0, 100.0);
  check_within(reader, "response_time", law.response_time, 0.0, 100.0);
  if (reader.given("response_distance"))
    check_positive(reader, "response_distance", law.response_distance, kMostLength);
  check_within(reader, "understeer", law.understeer, -1.0, 1.0);
  check_within(reader, "side_slip", law.side_slip, 0.0, 1.0);
  check_within(reader, "yaw_damping", law.yaw_damping, 0.0, 10.0);
}

/// One of several structs: the one whose kName is the text under `key`, the first of them when there is none and it may
/// be missing.
template <class... Choices>
std::variant<Choices...> read_choice(JsonReader& reader, const std::string& key, bool required,
                                     std::type_identity<std::variant<Choices...>>) {
  const std::vector<std::string> names = {Choices::kName...};
  const std::string name = required || reader.given(key) ? reader.text(key) : names.front();
  reader.skip(key);
  check_known(reader, key, name, names);
  std::variant<Choices...> chosen;
  const auto read_if = [&]<class T>(T choice) {
    if (name != T::kName) return;
    take_fields(reader, choice);
    finish(choice, reader);
    chosen = std::move(choice);
  };
  (read_if(Choices{}), ...);
  return chosen;
}

}  // namespace

void check_spec(const PathSteeringSpec& s, const JsonReader& reader) { check_positive(reader, "rate", s.rate, 1e6); }

namespace {

PathSteeringSpec read_steering(JsonReader reader) {
  PathSteeringSpec spec;
  take_fields(reader, spec);
  check_spec(spec, reader);
  spec.law = read_choice(reader, "law", false, std::type_identity<SteeringLaw>());
  reader.finish();
  return spec;
}

PathSpec read_path(JsonReader reader) {
  PathSpec spec;
  take_fields(reader, spec);
  check_within(reader, "x", spec.x, -kMostLength, kMostLength);
  check_within(reader, "y", spec.y, -kMostLength, kMostLength);
  check_within(reader, "heading_deg", spec.heading_deg, -360.0, 360.0);
  spec.shape = read_choice(reader, "kind", true, std::type_identity<PathShape>());
  if (reader.given("steering")) spec.steering = read_steering(reader.child("steering"));
  reader.finish();
  return spec;
}

SpeedSpec read_speed(JsonReader reader) {
  SpeedSpec spec;
  take_fields(reader, spec);
  // Below zero they come from the vehicle; a file cannot say that but by leaving them out.
  if (reader.given("proportional")) check_not_negative(reader, "proportional", spec.proportional);
  if (reader.given("integral")) check_not_negative(reader, "integral", spec.integral);
  check_within(reader, "hysteresis", spec.hysteresis, 0.0, 1.0);
  check_within(reader, "stop_speed", spec.stop_speed, 0.0, 10.0);
  spec.target = read_points(reader, "target", kSpeed);
  reader.finish();
  return spec;
}

constexpr std::array<std::pair<const PointRule*, DriverPoints InputSpec::*>, 4> kInputs = {{
    {&kThrottle, &InputSpec::throttle},
    {&kBrake, &InputSpec::brake},
    {&kSteering, &InputSpec::steering},
    {&kGear, &InputSpec::gear},
}};

InputSpec read_inputs(const std::filesystem::path& file) {
  const CsvFile csv(file, "a CSV file of a driver's inputs", {"time_s", "throttle", "brake", "steering", "gear"});
  InputSpec spec;
  for (const auto& [rule, points] : kInputs)
    if (csv.has(rule->second)) spec.*points = read_points(csv, *rule);
  return spec;
}

InputSpec read_inputs(JsonReader reader) {
  InputSpec spec;
  for (const auto& [rule, points] : kInputs) {
    reader.skip(rule->second);
    if (reader.given(rule->second)) spec.*points = read_points(reader, rule->second, *rule);
  }
  reader.finish();
  return spec;
}

/// What follows a loop follows no table.
void check_parts(const DriverSpec& spec, const JsonReader& reader) {
  const auto refuse = [&](bool both, const std::string& input, const std::string& loop) {
    if (both) reader.fail("inputs", fmt::format("gives {} beside '{}', expected one of the two", input, loop));
  };
  refuse(spec.speed && !spec.inputs.throttle.empty(), "throttle", "speed");
  refuse(spec.speed && !spec.inputs.brake.empty(), "brake", "speed");
  refuse(spec.path && !spec.inputs.steering.empty(), "steering", "path");
  const InputSpec& i = spec.inputs;
  if (!spec.speed && !spec.path && i.throttle.empty() && i.brake.empty() && i.steering.empty() && i.gear.empty())
    reader.fail("", "gives the driver nothing to do, expected 'inputs', 'speed' or 'path'");
}

}  // namespace

DriverSpec read_driver(const std::filesystem::path& file) {
  if (file.extension() == ".csv") {
    DriverSpec spec;
    spec.inputs = read_inputs(file);
    return spec;
  }
  return read_driver(load_json(file, "a driver in JSON or CSV"), file.string());
}

DriverSpec read_driver(const nlohmann::json& document, const std::string& file, const std::string& key) {
  JsonReader reader(document, file, key);
  reader.check_version(kFormatVersion, true);
  for (const char* key : {"$schema", "name", "inputs", "speed", "path"}) reader.skip(key);
  reader.finish();
  DriverSpec spec;
  if (reader.given("inputs")) {
    if (document["inputs"].is_string())
      spec.inputs = read_inputs(find_file(reader.text("inputs"), "inputs", file));
    else
      spec.inputs = read_inputs(reader.child("inputs"));
  }
  if (reader.given("speed")) spec.speed = read_speed(reader.child("speed"));
  if (reader.given("path")) spec.path = read_path(reader.child("path"));
  check_parts(spec, reader);
  return spec;
}

}  // namespace furrow::vehicle
