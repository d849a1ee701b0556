// What a calibration study may hold, in words: `furrow explain calibrate`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace furrow::calibrate {

struct CalibrationKey {
  std::string_view name, meaning;
  bool of_every_kind = true;  // else of the kinds that ask for it
};

/// Keys of the file, in the order in which people write them.
std::span<const CalibrationKey> calibration_keys();

/// Whether `key` is "calibrate", or begins with "calibrate.".
bool explains_calibrations(const std::string& key);

/// Of "calibrate", all keys and kinds; of "calibrate.targets", that key; of "calibrate.ring", the parameters of that
/// kind; of "calibrate.ring.bending", that parameter.
/// @throws Error(bad_input) for what is not known, with what looks like it
std::string explain_calibration(const std::string& key);

}  // namespace furrow::calibrate
