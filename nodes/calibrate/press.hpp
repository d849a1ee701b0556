// Kinds of calibration that press a tire: its file's values from load–deflection curves on plates and cleats.
//
// A target names a CSV file with the columns deflection_m and force_N, as press.csv of `furrow press` has them, and
// maybe sigma_N, the force's standard error. Lines of unloading are left out, and those without deflection. A
// prediction is what `furrow press` gives for the fitted file, to the tolerance of its solver: both go through the
// tire's reader and its static test.
#pragma once

#include <memory>
#include <span>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

/// Of tire files with `"model": "ring"`: bending, shear, tangential, sidewall_1, sidewall_2 or softening, sidewall_3,
/// air_share, tension_share, width. `softening` is k₂/√(3 k₁k₃), from 0 to 1, where the
/// sidewall's force would begin to fall.
std::span<const ParameterRule> ring_parameters();
std::unique_ptr<CalibrationModel> read_ring_calibration(CalibrationInput& input);

/// Of tire files with `"model": "planar"`: young_modulus, poisson_ratio, disc_young_modulus, contact_stiffness.
std::span<const ParameterRule> planar_parameters();
std::unique_ptr<CalibrationModel> read_planar_calibration(CalibrationInput& input);

}  // namespace furrow::calibrate
