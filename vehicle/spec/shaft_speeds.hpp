// Speeds of a driveline's shafts for one turn of its engine.
#pragma once

#include <vector>

#include "vehicle/spec/driveline_spec.hpp"

namespace furrow::vehicle {

/// Speeds in the order of the shafts, at engine speed 1 in a forward gear, counted from 0, with converter and clutch
/// closed; 0 for a shaft that the engine does not drive. @pre there is an engine
std::vector<double> shaft_speeds(const DrivelineSpec& line, std::size_t gear);

}  // namespace furrow::vehicle
