// Reads driver files: JSON (driver.schema.json), or a CSV file with the column time_s and any of throttle, brake,
// steering and gear. Files that a driver file names are searched for in its folder.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// @throws Error(bad_input) naming file, key or line, and what was expected
DriverSpec read_driver(const std::filesystem::path& file);
/// @param file for messages, and to find the files it names @param key of the document in this file, for messages
DriverSpec read_driver(const nlohmann::json& document, const std::string& file, const std::string& key = "");

/// Keys of a driver whose times or speeds seem to be in a wrong unit, and what is odd about them.
/// @param duration of the run, s
std::vector<std::pair<std::string, std::string>> unlikely_values(const DriverSpec& spec, double duration);

/// The JSON schema of driver files.
nlohmann::ordered_json driver_schema();

}  // namespace furrow::vehicle
