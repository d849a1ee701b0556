// A driver as a complete JSON document. Data from CSV files are in it as lists of points.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// A document from which read_driver() makes the same driver.
nlohmann::json driver_document(const DriverSpec& spec);

}  // namespace furrow::vehicle
