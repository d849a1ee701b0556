// Calibration studies in words, before anything is computed: `furrow explain calibrate` and `furrow validate`.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/study.hpp"

namespace furrow::calibrate {

/// Whether `key` is "calibrate", or begins with "calibrate.".
bool explains_calibrations(const std::string& key);

/// Of "calibrate", all keys and kinds; of "calibrate.targets", that key; of "calibrate.ring", the parameters of that
/// kind; of "calibrate.ring.bending", that parameter.
/// @throws Error(bad_input) for what is not known, with what looks like it
std::string explain_calibration(const std::string& key);

/// What the study fits to which data.
std::string calibration_check_text(const Calibration& calibration);
nlohmann::ordered_json calibration_check_json(const Calibration& calibration);

}  // namespace furrow::calibrate
