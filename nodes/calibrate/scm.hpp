// Kind `scm` of calibrations: empirical soil (terrain/scm) from the curves of plate and shear tests.
//
// A target names plate.csv or shear.csv of `furrow soil`, or a measured table of the same columns. Each width of a
// plate and each normal stress of a shear test is a target of its own, named after both. Starts that neither the study
// nor the soil file gives are the fits of `furrow soil` to the same curves (terrain/soil/fits.hpp).
#pragma once

#include <memory>
#include <span>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

/// bekker_k_c, bekker_k_phi, bekker_n, mohr_cohesion, mohr_friction_angle, janosi_k: keys of the section `terrain`.
std::span<const ParameterRule> scm_parameters();
std::unique_ptr<CalibrationModel> read_scm_calibration(CalibrationInput& input);

}  // namespace furrow::calibrate
