// Magnitudes that look like another unit in a vehicle file: nothing forbids them, but no vehicle has them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Keys, and what is odd about their values. @param mass of the whole vehicle without tires, kg
std::vector<std::pair<std::string, std::string>> unlikely_values(const VehicleSpec& spec, double mass);

}  // namespace furrow::vehicle
