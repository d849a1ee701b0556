// Whether figures were reached, for models that answer with noise: what calibration.json, the fitted file and the
// messages say of each.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/kind.hpp"
#include "nodes/calibrate/optimum.hpp"

namespace furrow::calibrate {

/// not_known: the surrogate errs by more than twice the target's standard error, so it cannot be told. reached: within
/// two standard errors, of target and surrogate together. out_of_range: beyond what all evaluations span, by more than
/// two. not_together: within that span, and still not met with the others.
enum class ReachState { reached, out_of_range, not_together, not_known };
/// @param sigma the target's standard error
ReachState reach_state(const Reach& reach, double data, double sigma);

/// Entries of calibration.json for the figures of a target. @param first of them among all points of the set
nlohmann::ordered_json figures_json(const Target& target, const Prediction& prediction, std::size_t first,
                                    const std::vector<Reach>& reach);

/// One for each figure that was not reached, with the range that was.
std::vector<std::string> reach_warnings(const std::vector<Target>& fitted, const std::vector<Reach>& reach);

/// "friction_angle_deg 31 ± 0.4 (target 31.1 ± 1)", one after another.
std::string reach_text(const std::vector<Target>& targets, const std::vector<Reach>& reach);

/// What soil files have under `measured`: mean and standard error of every figure, as evaluated.
nlohmann::ordered_json measured_json(const std::vector<Target>& targets, const Prediction& prediction);

}  // namespace furrow::calibrate
