// What `furrow validate` says of a calibration study: what is fitted to what, before anything is computed.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/study.hpp"

namespace furrow::calibrate {

std::string calibration_check_text(const Calibration& calibration);
nlohmann::ordered_json calibration_check_json(const Calibration& calibration);

}  // namespace furrow::calibrate
