// The vehicles that come with the program, for tests.
#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "vehicle/spec/read_vehicle.hpp"

namespace furrow::testing {

inline nlohmann::json shipped_text(const std::string& name) {
  return nlohmann::json::parse(std::ifstream(VEHICLE_DATA "/" + name));
}
inline vehicle::VehicleSpec shipped(const std::string& name) {
  return vehicle::read_vehicle(std::filesystem::path(VEHICLE_DATA "/" + name));
}

}  // namespace furrow::testing
