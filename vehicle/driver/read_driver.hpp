// Reads driver files: JSON (driver.schema.json), or a CSV file with the column time_s and any of throttle, brake,
// steering and gear. Files that a driver file names are searched for in its folder.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// @throws Error(bad_input) naming file, key or line, and what was expected
DriverSpec read_driver(const std::filesystem::path& file);
/// @param file for messages, and to find the files it names @param key of the document in this file, for messages
DriverSpec read_driver(const nlohmann::json& document, const std::string& file, const std::string& key = "");

/// The JSON schema of driver files.
nlohmann::ordered_json driver_schema();

}  // namespace furrow::vehicle
