#include "vehicle/driver/read_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

#include <fmt/format.h>

#include "protocol/core/key.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"
#include "protocol/files/nearest_words.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/read_points.hpp"
#include "vehicle/spec/spec_reader.hpp"
#include "vehicle/spec/value_rules.hpp"

namespace furrow::vehicle {

void check_spec(const PathSteeringSpec&, const JsonReader&) {}

namespace {

constexpr int kFormatVersion = 1;
constexpr double kShortDrive = 0.02, kLongDrive = 300.0,
                 kMostRuns = 100.0;           // usual last times of a table: s, s, durations of the run
constexpr double kSlow = 0.01, kFast = 40.0;  // usual largest speeds, m/s
constexpr double kLeastSpacing = 1e-3;        // of waypoints, m
constexpr double kSharpestTurn = 120.0;       // at a waypoint, degrees

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
constexpr PointRule kLock{"time_s", "lock", 0.0, 1.0, "0 (open) or 1 (locked)", nullptr, 0.0, true};
constexpr PointRule kSpeed{"time_s", "speed_m_s", 0.0, 100.0, "a speed from 0 to 100 m/s"};
constexpr PointRule kWaypoint{"x_m", "y_m", -keys::kMostLength, keys::kMostLength, "at most 1e6"};

constexpr const char* kSeriesSchema =
    R"({"description": "A number for all times; or points [time in s, value] whose times rise, straight lines between )"
    R"(them; or the name of a CSV file.",
  "anyOf": [{"type": "number"}, {"type": "string"},
            {"type": "array", "minItems": 1,
             "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}}]})";
constexpr const char* kGearSchema =
    R"({"description": "'auto', -1 (reverse), 0 (neutral) or a gear from 1 to 20; or points [time in s, gear], each )"
    R"(of which holds until the next; or the name of a CSV file.",
  "anyOf": [{"type": "integer", "minimum": -1, "maximum": 20}, {"type": "string"},
            {"type": "array", "minItems": 1,
             "items": {"type": "array", "minItems": 2, "maxItems": 2,
                       "items": [{"type": "number"},
                                 {"anyOf": [{"const": "auto"},
                                            {"type": "integer", "minimum": -1, "maximum": 20}]}]}}]})";

constexpr const char* kLockSchema =
    R"({"description": "Locks of all differentials that have one, 0 (open) or 1 (locked); or points )"
    R"([time in s, lock], each of which holds until the next; or the name of a CSV file. )"
    R"(Not for vehicles without locks.",
  "anyOf": [{"enum": [0, 1]}, {"type": "string"},
            {"type": "array", "minItems": 1,
             "items": {"type": "array", "minItems": 2, "maxItems": 2,
                       "items": [{"type": "number"}, {"enum": [0, 1]}]}}]})";

// Parts of each choice that are read separately.

template <class Choice>
void finish(Choice&, JsonReader&) {}

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

/// One of several structs: the one whose kName is the text under `key`, or the first if the key is optional and
/// missing.
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

PathSteeringSpec read_steering(JsonReader reader) {
  PathSteeringSpec spec;
  take_fields(reader, spec);
  spec.law = read_choice(reader, "law", false, std::type_identity<SteeringLaw>());
  reader.finish();
  return spec;
}

PathSpec read_path(JsonReader reader) {
  PathSpec spec;
  take_fields(reader, spec);
  spec.shape = read_choice(reader, "kind", true, std::type_identity<PathShape>());
  if (reader.given("steering")) spec.steering = read_steering(reader.child("steering"));
  reader.finish();
  return spec;
}

SpeedSpec read_speed(JsonReader reader) {
  SpeedSpec spec;
  take_fields(reader, spec);
  spec.target = read_points(reader, "target", kSpeed);
  reader.finish();
  return spec;
}

constexpr std::array<std::pair<const PointRule*, DriverPoints InputSpec::*>, 5> kInputs = {{
    {&kThrottle, &InputSpec::throttle},
    {&kBrake, &InputSpec::brake},
    {&kSteering, &InputSpec::steering},
    {&kGear, &InputSpec::gear},
    {&kLock, &InputSpec::lock},
}};

InputSpec read_inputs(const std::filesystem::path& file) {
  const CsvFile csv(file, "a CSV file of a driver's inputs",
                    {"time_s", "throttle", "brake", "steering", "gear", "lock"});
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

/// Refuses a table for a part that follows a loop.
void check_parts(const DriverSpec& spec, const JsonReader& reader) {
  const auto refuse = [&](bool both, const std::string& input, const std::string& loop) {
    if (both) reader.fail("inputs", fmt::format("gives {} beside '{}', expected one of the two", input, loop));
  };
  refuse(spec.speed && !spec.inputs.throttle.empty(), "throttle", "speed");
  refuse(spec.speed && !spec.inputs.brake.empty(), "brake", "speed");
  refuse(spec.path && !spec.inputs.steering.empty(), "steering", "path");
  const InputSpec& i = spec.inputs;
  const bool any = std::ranges::any_of(kInputs, [&](const auto& input) { return !(i.*input.second).empty(); });
  if (!spec.speed && !spec.path && !any)
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

std::vector<std::pair<std::string, std::string>> unlikely_values(const DriverSpec& spec, double duration) {
  std::vector<std::pair<std::string, std::string>> odd;
  const auto look = [&](const std::string& key, double value, double low, double high, const char* unit) {
    if (std::string text = unusual_text(value, low, high, unit); !text.empty()) odd.emplace_back(key, std::move(text));
  };
  const double longest = std::max(kLongDrive, kMostRuns * duration);
  const auto times = [&](const std::string& key, const DriverPoints& points) {
    if (!points.empty()) look(key, points.back().first, kShortDrive, longest, "s");
  };
  for (const auto& [rule, points] : kInputs) times(std::string("inputs.") + rule->second, spec.inputs.*points);
  if (!spec.speed) return odd;
  times("speed.target", spec.speed->target);
  double fastest = 0.0;
  for (const auto& [time, speed] : spec.speed->target) fastest = std::max(fastest, speed);
  look("speed.target", fastest, kSlow, kFast, "m/s");
  return odd;
}

nlohmann::ordered_json driver_schema() {
  using Json = nlohmann::ordered_json;
  SchemaWriter writer;
  // One of several structs, each with the keys that all share.
  const auto choice = [&]<class Shared, class... Choices>(const Shared&, const std::variant<Choices...>&,
                                                          const Key& which) {
    Json options = Json::array();
    const auto add = [&]<class T>(const T&) {
      Json option = object_schema(T::kName);
      Key own = which;
      if (!options.empty()) own.missing = Missing::mistake;
      add_key(option, own, {{"const", T::kName}});
      writer.add_keys<T>(option);
      writer.add_keys<Shared>(option);
      options.push_back(option);
    };
    (add(Choices{}), ...);
    return options;
  };
  Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Furrow driver"}};
  root.update(
      object_schema("What a driver does, against time or in closed loops. SI units. A CSV file with the column time_s "
                    "and any of throttle, brake, steering, gear and lock is a driver file too."));
  root["anyOf"] = {{{"required", {"inputs"}}}, {{"required", {"speed"}}}, {{"required", {"path"}}}};
  add_key(root, key("$schema"), {{"type", "string"}});
  add_key(root, needed("format_version"), {{"const", 1}});
  add_key(root, key("name"), {{"type", "string"}});
  add_key(root, key("inputs"),
          {{"anyOf", {{{"type", "string"}}, {{"$ref", "#/definitions/inputs"}}}},
           {"description",
            "Functions of time; a text names a CSV file of them. Throttle and brake are not given beside 'speed', nor "
            "steering beside 'path'."}});
  add_key(root, key("speed"), {{"$ref", "#/definitions/speed"}});
  add_key(root, key("path"), {{"$ref", "#/definitions/path"}});
  Json& parts = writer.definitions;
  parts["series"] = Json::parse(kSeriesSchema);
  parts["gear"] = Json::parse(kGearSchema);
  parts["lock"] = Json::parse(kLockSchema);
  parts["inputs"] = writer.object<InputSpec>("Functions of time.");
  parts["speed"] = writer.object<SpeedSpec>("Holds a speed by a PI law that presses throttle or brake.");
  parts["steering"] = {{"oneOf", choice(PathSteeringSpec{}, SteeringLaw{}, key("law"))},
                       {"description", PathSteeringSpec::kSchema.description}};
  parts["path"] = {{"oneOf", choice(PathSpec{}, PathShape{}, needed("kind"))},
                   {"description",
                    "Follows a path, which begins at (x, y) and goes along its own x axis there, and continues "
                    "straight at its end."}};
  root["definitions"] = parts;
  return root;
}

}  // namespace furrow::vehicle
