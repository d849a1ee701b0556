// A calibration study: the fitted parameters, their model and the data.
//
//   {"calibrate": "ring",                              kind (kinds.cpp)
//    "start": "hmmwv_ring.json",                       relative to the study, then to the data folders
//    "parameters": {"bending": {"lower": 10, "upper": 1e4, "start": 100, "scale": "log"}, …},
//    "targets": [{"data": "plate.csv", "on": "plate", "pressure": 200e3}, …],    fitted
//    "held_out": [{"data": "cleat_100.csv", "on": "cleat", "cleat_width": 0.1}], predicted only
//    "starts": 8, "seed": 1,                           the start's own values and 7 random ones
//    "evaluations": 20,                                 of a noisy model, at most
//    "result": "my_ring.json"}                         the fitted file, in the folder of results
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

struct Calibration {
  std::filesystem::path file;
  std::string name;         // file name without extension
  std::string description;  // empty: none
  const CalibrationKind* kind = nullptr;
  std::filesystem::path start;  // resolved
  std::vector<Parameter> parameters;
  std::unique_ptr<CalibrationModel> model;
  int starts = 8;
  std::uint64_t seed = 1;
  int evaluations = 0;  // of a noisy model at most
  std::string result;   // name of the fitted file
  /// Hash of all that a prediction depends on: start file, parameters, targets and the program's version.
  std::string digest;
};

struct CalibrationKey {
  std::string_view name, meaning;
  bool of_every_kind = true;  // otherwise only of the kinds that have it
};
/// Keys of the file, in the usual order.
std::span<const CalibrationKey> calibration_keys();

/// Checks whether a file, or a calibration that comes with the program, declares itself to be one.
bool is_calibration(const std::filesystem::path& name);

/// @param name of a file, or of a calibration that comes with the program, such as "calibrate_ring.json"
/// @throws Error(bad_input) naming file and key
Calibration load_calibration(const std::filesystem::path& name);

}  // namespace furrow::calibrate
