// A driver as a JSON document that holds all of it: what came from CSV files is in it as lists of points.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// What read_driver() makes into the same driver again.
nlohmann::json driver_document(const DriverSpec& spec);

}  // namespace furrow::vehicle
