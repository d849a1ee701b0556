// The kind of calibration that fits the Magic Formula of a tire property file (.tir) to tables of `furrow sweep` on
// hard ground (tire/handling/sweep_table.hpp): longitudinal slip, slip angle, camber and
// load against forces and moments.
//
// A target names a table and what of it is compared: "of": "fx", "fy", "mx", "my", "mz" (ISO-W axes), "loaded_radius",
// or "rolling_radius" of the rows that roll freely. Parameters are coefficients by their names in the file. Beside the
// tire file, which names them, the calibration leaves a fitted .tir and the tables in the layout of TYDEX (.tdx); both
// state the ranges of slips and load that were fitted, and the residuals.
#pragma once

#include <memory>
#include <span>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

std::span<const ParameterRule> handling_parameters();
std::unique_ptr<CalibrationModel> read_handling_calibration(CalibrationInput& input);

}  // namespace furrow::calibrate
