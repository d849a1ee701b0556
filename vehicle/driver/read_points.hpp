// Reads points of functions of time and waypoints, from JSON or CSV, by the same rules:
//
//   "throttle": 0.5                      the same at any time
//   "throttle": [[0, 0], [0.5, 1]]       time in s and value
//   "target": "speeds.csv"               a table with the columns of the rule
#pragma once

#include <filesystem>
#include <string>

#include "protocol/files/csv_file.hpp"
#include "protocol/files/json_reader.hpp"
#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// The values that such a list may contain.
struct PointRule {
  const char* first;   // column and name of the first value: "time_s", which increases, or "x_m"
  const char* second;  // column and name of the second value: "throttle"
  double least, most;  // of the second
  const char* expected;
  const char* word = nullptr;  // accepted instead of the second value
  double meaning = 0.0;        // value of the word
  bool whole = false;          // the second is a whole number
};

/// @throws Error(bad_input) naming file, key or line, and what was expected
DriverPoints read_points(JsonReader& reader, const std::string& key, const PointRule& rule);
DriverPoints read_points(const CsvFile& file, const PointRule& rule);

}  // namespace furrow::vehicle
