// What nothing forbids in a vehicle file, but is hardly meant: magnitudes that look like another unit
// (part_magnitudes.hpp), a gearbox whose mark the engine never reaches, an engine that stalls.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Keys, and what is odd about their values. @param mass of the whole vehicle without tires, kg
std::vector<std::pair<std::string, std::string>> unlikely_values(const VehicleSpec& spec, double mass);

}  // namespace furrow::vehicle
