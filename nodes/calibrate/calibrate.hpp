// Fits a model to data: `furrow calibrate STUDY`. The folder of results holds
//
//   evaluations.csv    every prediction that was computed, by its parameters (evaluations.hpp)
//   calibration.json   parameters with their confidence, how well each target is met, what the data do not determine,
//                      and how every start went
//   fit.csv            data and model at every point
//   <result>.json      the fitted file
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/calibrate/optimum.hpp"
#include "nodes/calibrate/statistics.hpp"
#include "nodes/calibrate/study.hpp"

namespace furrow::calibrate {

inline constexpr const char* kCalibration = "calibration.json";

struct CalibrationResults {
  Optimum optimum;
  Confidence confidence;
  std::vector<double> values;   // of the parameters, in their units
  Prediction fitted, held_out;  // there
  std::size_t asked = 0;        // evaluations, whether computed or known before
  std::size_t computed = 0;
  double processor_time = 0.0;  // of all evaluations, whenever they were made, s; 0: not told
};

/// @param folder of the results; its table of evaluations is read and continued
/// @param progress what is done, 0…1; called before each evaluation too, and may throw to stop
/// @throws Error(bad_input) when the folder holds another calibration or the model has no answer to the start's own
/// values for a reason of input, Error(physics) when it has none anywhere, Error(stopped)
CalibrationResults calibrate(const Calibration& calibration, const std::filesystem::path& folder,
                             const ProgressCall& progress);

/// Calls visit(target, k, index among all points) for every figure.
template <class Visit>
void each_figure(const std::vector<Target>& targets, Visit&& visit) {
  std::size_t at = 0;
  for (const Target& target : targets)
    for (std::size_t k = 0; k < target.y.size(); ++k) visit(target, k, at++);
}

/// not_known: the surrogate errs by more than twice the target's standard error, so it cannot be told. reached: within
/// two standard errors, of target and surrogate together. out_of_range: beyond what all evaluations span, by more than
/// two. not_together: within that span, and still not met with the others.
enum class ReachState { reached, out_of_range, not_together, not_known };
/// @param sigma the target's standard error
ReachState reach_state(const Reach& reach, double data, double sigma);

/// calibration.json.
nlohmann::ordered_json calibration_json(const Calibration& calibration, const CalibrationResults& results);
/// What a reader must know before trusting the result: parameters at bounds, what is not
/// determined, starts that differ.
std::vector<std::string> calibration_warnings(const Calibration& calibration, const CalibrationResults& results);
/// calibration.json, fit.csv and the fitted file. @throws Error(io)
void write_calibration(const Calibration& calibration, const CalibrationResults& results,
                       const std::filesystem::path& folder);

}  // namespace furrow::calibrate
