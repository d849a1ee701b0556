// Reads vehicle files (data/vehicle.schema.json describes them). Files describe the left side; the right side is its
// mirror image unless the axle has the key `right`. Tire files are not read.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// @throws Error(bad_input) naming file, key and what was expected
VehicleSpec read_vehicle(const std::filesystem::path& file);
/// @param file for messages
VehicleSpec read_vehicle(const nlohmann::json& document, const std::string& file);

/// The JSON schema of vehicle files.
nlohmann::ordered_json vehicle_schema();

}  // namespace furrow::vehicle
