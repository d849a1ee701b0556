// Calibration studies in words, before anything is computed: `furrow explain calibrate` and `furrow validate`.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/study.hpp"

namespace furrow::calibrate {

/// Checks whether `key` is "calibrate", or begins with "calibrate.".
bool explains_calibrations(const std::string& key);

/// Explains all keys and kinds for "calibrate", that key for "calibrate.targets", the parameters of that kind for
/// "calibrate.ring", and that parameter for "calibrate.ring.bending".
/// @throws Error(bad_input) for an unknown key, with similar ones
std::string explain_calibration(const std::string& key);

/// Describes what the study fits, and to which data.
std::string calibration_check_text(const Calibration& calibration);
nlohmann::ordered_json calibration_check_json(const Calibration& calibration);

}  // namespace furrow::calibrate
