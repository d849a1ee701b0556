// Driver files: their drivers, and the messages of refused files.
#include "vehicle/driver/read_driver.hpp"
#include "tests/refusal.hpp"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "tests/temporary_folder.hpp"
#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/lane_change.hpp"

using namespace furrow;
using namespace furrow::testing;
using namespace furrow::vehicle;
using nlohmann::json;

namespace {

class DriverFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  /// A driver file with these sections.
  DriverSpec read(const std::string& sections) const {
    return read_driver(write("driver.json", "{\"format_version\": 1" + sections + "}"));
  }
  void expect_refused(const std::filesystem::path& file, const std::string& message) const {
    const std::string text = refusal(ExitCode::bad_input, [&] { read_driver(file); });
    EXPECT_TRUE(text.starts_with(folder_.path().string())) << text;
    EXPECT_TRUE(holds(text, message)) << text << "\nexpected: " << message;
  }
  TemporaryFolder folder_;
};

TEST_F(DriverFile, all_its_keys_are_read) {
  const DriverSpec spec = read(R"(, "name": "all",
    "inputs": {"gear": [[0, "auto"], [3, 2], [5, -1]]},
    "speed": {"target": [[0, 0], [2, 5]], "proportional": 0.1, "integral": 0.02, "hysteresis": 0, "stop_speed": 0.2},
    "path": {"kind": "circle", "radius": 20, "lead_in": 5, "angle_deg": 720, "turn": "right", "x": 1, "y": 2,
             "heading_deg": 90, "steering": {"law": "stanley", "gain": 2, "soft_speed": 0.5, "rate": 0.7}})");
  EXPECT_EQ(spec.inputs.gear, (DriverPoints{{0, gear_request::automatic}, {3, 2}, {5, gear_request::reverse}}));
  ASSERT_TRUE(spec.speed && spec.path);
  EXPECT_EQ(spec.speed->target, (DriverPoints{{0, 0}, {2, 5}}));
  EXPECT_EQ(spec.speed->proportional, 0.1);
  EXPECT_EQ(spec.speed->integral, 0.02);
  EXPECT_EQ(spec.speed->hysteresis, 0.0);
  EXPECT_EQ(spec.speed->stop_speed, 0.2);
  const auto& circle = std::get<CirclePath>(spec.path->shape);
  EXPECT_EQ(circle.radius, 20.0);
  EXPECT_EQ(circle.lead_in, 5.0);
  EXPECT_EQ(circle.angle_deg, 720.0);
  EXPECT_EQ(circle.turn, "right");
  EXPECT_EQ(spec.path->y, 2.0);
  EXPECT_EQ(spec.path->heading_deg, 90.0);
  EXPECT_EQ(std::get<Stanley>(spec.path->steering.law).gain, 2.0);
  EXPECT_EQ(spec.path->steering.rate, 0.7);
}

TEST_F(DriverFile, says_the_same_in_json_and_csv) {
  const DriverSpec from_json = read(R"(, "inputs": {"throttle": [[0, 0], [0.5, 0], [0.6, 1]],
    "gear": [[0, 1], [0.5, 1], [0.6, "auto"]], "lock": [[0, 0], [0.5, 1], [0.6, 0]]})");
  const auto csv =
      write("inputs.csv",
            "\xEF\xBB\xBF# a start\r\ntime_s, throttle, gear, lock\r\n0,0,1,0\r\n\r\n0.5,0,1,1\r\n0.6,1,auto,0\r\n");
  const DriverSpec direct = read_driver(csv), named = read(R"(, "inputs": "inputs.csv")");
  for (const DriverSpec* spec : {&direct, &named}) {
    EXPECT_EQ(spec->inputs.throttle, from_json.inputs.throttle);
    EXPECT_EQ(spec->inputs.gear, from_json.inputs.gear);
    EXPECT_EQ(spec->inputs.lock, from_json.inputs.lock);
    EXPECT_TRUE(spec->inputs.brake.empty());
  }
  write("speed.csv", "time_s,speed_m_s\n0,0\n2,5\n");
  write("way.csv", "x_m,y_m\n0,0\n5,1\n9,4\n");
  const DriverSpec spec =
      read(R"(, "speed": {"target": "speed.csv"}, "path": {"kind": "waypoints", "points": "way.csv"})");
  EXPECT_EQ(spec.speed->target, (DriverPoints{{0, 0}, {2, 5}}));
  EXPECT_EQ(std::get<WaypointPath>(spec.path->shape).points, (DriverPoints{{0, 0}, {5, 1}, {9, 4}}));
  EXPECT_EQ(read(R"(, "speed": {"target": 4})").speed->target, (DriverPoints{{0, 4}}));
}

TEST_F(DriverFile, that_is_wrong_is_refused_by_key) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "gives the driver nothing to do, expected 'inputs', 'speed' or 'path'"},
      {R"(, "inputs": {})", "gives the driver nothing to do"},
      {R"(, "sped": {"target": 4})", "key 'sped': is unknown, expected 'speed'?"},
      {R"(, "inputs": {"throttel": 1})", "key 'inputs.throttel': is unknown, expected 'throttle'?"},
      {R"(, "inputs": {"throttle": 1.2})", "key 'inputs.throttle': throttle is 1.2, expected a number from 0 to 1"},
      {R"(, "inputs": {"brake": [[0, 0], [1, -0.1]]})",
       "key 'inputs.brake[1]': brake is -0.1, expected a number from 0"},
      {R"(, "inputs": {"steering": [[0, 0], [0, 1]]})",
       "key 'inputs.steering[1]': time_s is 0 after 0, expected times that"},
      {R"(, "inputs": {"steering": [[0, 0], [1, "left"]]})", "steering is 'left', expected a number from -1 to 1"},
      {R"(, "inputs": {"steering": [[0, 0, 1]]})", "key 'inputs.steering[0]': is [0,0,1], expected [time_s, steering]"},
      {R"(, "inputs": {"steering": []})", "key 'inputs.steering': is [], expected at least one point"},
      {R"(, "inputs": {"steering": {}})",
       "key 'inputs.steering': is {}, expected a list of [time_s, steering], the name"},
      {R"(, "inputs": {"gear": 1.5})", "key 'inputs.gear': gear is 1.5, expected 'auto', -1 (reverse), 0"},
      {R"(, "inputs": {"gear": "D"})",
       "key 'inputs.gear': is 'D', expected a list of [time_s, gear], the name of a CSV file or 'auto', "},
      {R"(, "inputs": {"gear": -2})", "gear is -2, expected 'auto'"},
      {R"(, "inputs": {"gear": [[0, "drive"]]})", "key 'inputs.gear[0]': gear is 'drive', expected 'auto'"},
      {R"(, "inputs": {"lock": 0.5})", "key 'inputs.lock': lock is 0.5, expected 0 (open) or 1 (locked)"},
      {R"(, "inputs": {"lock": [[0, 0], [1, 2]]})", "key 'inputs.lock[1]': lock is 2, expected 0 (open) or 1 (locked)"},
      {R"(, "inputs": {"lock": true})", "key 'inputs.lock': is true, expected a list of [time_s, lock]"},
      {R"(, "inputs": "none.csv")", "key 'inputs': 'none.csv' does not exist"},
      {R"(, "inputs": {"throttle": 1}, "speed": {"target": 4})", "key 'inputs': gives throttle beside 'speed'"},
      {R"(, "inputs": {"brake": 1}, "speed": {"target": 4})", "key 'inputs': gives brake beside 'speed'"},
      {R"(, "inputs": {"steering": 1}, "path": {"kind": "straight", "length": 4})", "gives steering beside 'path'"},
      {R"(, "speed": {})", "key 'speed.target': is missing"},
      {R"(, "speed": {"target": -1})", "key 'speed.target': speed_m_s is -1, expected a speed from 0 to 100 m/s"},
      {R"(, "speed": {"target": 5, "integral": -1})",
       "key 'speed.integral': is -1 1/m, expected a number, 0 or more 1/m"},
      {R"(, "speed": {"target": 5, "hysteresis": 2})", "key 'speed.hysteresis': is 2, expected a number, 0 to 1"},
      {R"(, "speed": {"target": 5, "stop_speed": "slow"})", "key 'speed.stop_speed': is 'slow', expected a number"},
      {R"(, "path": {"length": 4})", "key 'path.kind': is missing, expected a text"},
      {R"(, "path": {"kind": "cirkle"})", "key 'path.kind': 'cirkle' is unknown, expected 'circle'?"},
      {R"(, "path": {"kind": "circle"})", "key 'path.radius': is missing, expected a number"},
      {R"(, "path": {"kind": "circle", "radius": 0})",
       "key 'path.radius': is 0 m, expected a number, above 0 up to 1e6 m"},
      {R"(, "path": {"kind": "circle", "radius": 5, "turn": "up"})",
       "key 'path.turn': is 'up', expected 'left' or 'right'"},
      {R"(, "path": {"kind": "circle", "radius": 5, "angle_deg": 40000})",
       "key 'path.angle_deg': is 40e3 deg, expected"},
      {R"(, "path": {"kind": "straight", "length": 5, "radius": 4})", "key 'path.radius': is unknown"},
      {R"(, "path": {"kind": "straight", "length": 5, "heading_deg": 400})",
       "key 'path.heading_deg': is 400 deg, expected"},
      {R"(, "path": {"kind": "double_lane_change", "track": "iso_3888"})", "key 'path.track': is 'iso_3888', expected"},
      {R"(, "path": {"kind": "double_lane_change", "lead_in": -1})", "key 'path.lead_in': is -1 m, expected"},
      {R"(, "path": {"kind": "waypoints"})", "key 'path.points': is missing, expected a list of [x_m, y_m]"},
      {R"(, "path": {"kind": "waypoints", "points": 3})", "key 'path.points': is 3, expected a list of [x_m, y_m]"},
      {R"(, "path": {"kind": "waypoints", "points": [[0, 0]]})",
       "key 'path.points': has one point, expected two or more"},
      {R"(, "path": {"kind": "waypoints", "points": [[0, 0], [1, 0], [1, 0]]})", "has points 2 and 3 at one place"},
      {R"(, "path": {"kind": "waypoints", "points": [[0, 0], [9, 0], [0, 1]]})",
       "turns by 174° at point 2, expected at most"},
      {R"(, "path": {"kind": "straight", "length": 5, "steering": {"law": "stan"}})",
       "key 'path.steering.law': 'stan'"},
      {R"(, "path": {"kind": "straight", "length": 5, "steering": {"gain": 2}})",
       "key 'path.steering.gain': is unknown"},
      {R"(, "path": {"kind": "straight", "length": 5, "steering": {"rate": 0}})", "key 'path.steering.rate': is 0"},
      {R"(, "path": {"kind": "straight", "length": 5, "steering": {"lookahead_distance": 0}})",
       "lookahead_distance': is 0"},
  };
  for (const auto& [sections, message] : cases)
    expect_refused(write("driver.json", "{\"format_version\": 1" + sections + "}"), message);
  expect_refused(write("driver.json", "{}"), "key 'format_version': is missing");
  expect_refused(write("driver.json", R"({"format_version": 2, "speed": {"target": 4}})"), "newer than this program");
  expect_refused(folder_.path() / "none.json", "does not exist, expected a driver in JSON or CSV");
}

TEST_F(DriverFile, in_csv_that_is_wrong_is_refused_by_line) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is empty, expected a CSV file of a driver's inputs"},
      {"time_s,throttle\n", "has no rows of values, expected a CSV file of a driver's inputs"},
      {"throttle,brake\n0,1\n", "key 'line 1': has no column 'time_s', expected it and any of 'throttle'"},
      {"time_s\n0\n", "key 'line 1': has no column besides 'time_s', expected any of"},
      {"time_s,trottle\n0,1\n", "key 'line 1': column 'trottle' is unknown, expected 'throttle'?"},
      {"time_s;throttle\n0;1\n", "key 'line 1': has ';' between its values"},
      {"time_s,brake,brake\n0,1,1\n", "key 'line 1': column 'brake' is there twice, expected once"},
      {"# start\n\ntime_s,throttle\n0\n", "key 'line 4': has 1 values, expected 2"},
      {"time_s,throttle\n0,1\n1,full\n", "key 'line 3': throttle is 'full', expected a number"},
      {"time_s,throttle\n0,\n", "key 'line 2': throttle is '', expected a number"},
      {"time_s,throttle\nnan,1\n", "key 'line 2': time_s is 'nan', expected a number"},
      {"time_s,throttle\n0,0\n1,1.5\n", "key 'line 3': throttle is 1.5, expected a number from 0 to 1"},
      {"time_s,throttle\n0,0\n2,1\n1,0\n", "key 'line 4': time_s is 1 after 2, expected times that rise"},
      {"time_s,gear\n0,-2\n", "key 'line 2': gear is -2, expected 'auto', -1 (reverse)"},
      {"time_s,gear\n0,2nd\n", "key 'line 2': gear is '2nd', expected a number"},
  };
  for (const auto& [text, message] : cases) expect_refused(write("inputs.csv", text), message);
}

TEST_F(DriverFile, times_in_milliseconds_and_speeds_in_kilometres_an_hour_are_named_with_a_guess) {
  const auto odd = [&](const std::string& sections, double duration) {
    std::string all;
    for (const auto& [key, what] : unlikely_values(read(sections), duration)) all += key + ": " + what + "\n";
    return all;
  };
  EXPECT_EQ(odd(R"(, "inputs": {"throttle": [[0, 0], [5000, 1]], "brake": 0})", 6.0),
            "inputs.throttle: 5000 s is unusually large, usual is 0.02 to 600 s: did you mean 5 (ms)?\n");
  EXPECT_EQ(
      odd(R"(, "speed": {"target": [[0, 0], [2, 80], [3, 70]]})", 6.0),
      "speed.target: 80 m/s is unusually large, usual is 0.01 to 40 m/s: did you mean 22.22 (km/h) or 0.08 (mm/s)?\n");
  EXPECT_EQ(odd(R"(, "inputs": {"steering": [[0, 0], [1800, 0.1]]}, "speed": {"target": [[0, 0], [1800, 30]]})", 20.0),
            "");
}

TEST(DriverSchema, lists_the_tracks_that_there_are) {
  const json schema = driver_schema();
  json names;
  for (const LaneChangeTrack& track : kLaneChangeTracks) names.push_back(track.name);
  int found = 0;
  for (const json& path : schema["definitions"]["path"]["oneOf"]) {
    if (!path["properties"].contains("track")) continue;
    EXPECT_EQ(path["properties"]["track"]["enum"], names);
    ++found;
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
