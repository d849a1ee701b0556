// Values that no rule forbids in a vehicle file but that are hardly intended: magnitudes that seem to be in a wrong
// unit (part_magnitudes.hpp), a shift speed that the engine never reaches, an engine that stalls.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Keys, and what is odd about their values. @param mass of the whole vehicle without tires, kg
std::vector<std::pair<std::string, std::string>> unlikely_values(const VehicleSpec& spec, double mass);

/// Speed above which an engine at full throttle only brakes, rpm; none if its tables contain no such speed.
std::optional<double> highest_speed(const EngineSpec& engine);

}  // namespace furrow::vehicle
