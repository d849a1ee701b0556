// Kind of calibration that fits grains to the strength of a soil: what the virtual soil tests (terrain/soil) measure on
// them against what was measured on the soil.
//
//   "start": "drawbar_pull_small.json", "set": {"terrain.material": "loose_sand.json"},   a scenario with grains
//   "tests": {"seeds": 2, "stresses": [5e3, 15e3, 40e3], "speed": 0.1},
//   "targets": [{"quantity": "friction_angle_deg", "data": "lete_sand.json", "sigma": 1.0},     value of a soil file
//               {"quantity": "bulk_density_kg_m3", "value": 1500, "sigma": 30}]
//
// A prediction is what `furrow soil` gives for the start with the parameters as settings, to the last bit, with its
// standard errors between beds. Only those tests run that the targets need. What a test gives for held-out targets is
// kept with the fitted ones of the same parameters.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

inline constexpr std::string_view kGrainKeys[] = {"set", "tests"};

/// friction, rolling_friction, cohesion, radius, size_spread, settling_friction, compaction_pressure, density,
/// young_modulus: keys of the section `terrain`.
std::span<const ParameterRule> grain_parameters();
/// Figures of soil.json, by the names that targets ask for.
std::vector<TargetQuantity> grain_quantities();
std::unique_ptr<CalibrationModel> read_grain_calibration(CalibrationInput& input);

}  // namespace furrow::calibrate
