// Fits a model to data: `furrow calibrate STUDY`. The folder of results contains
//
//   evaluations.csv    every computed prediction, by its parameters (evaluations.hpp)
//   calibration.json   parameters with their confidence, how well each target is met, which combinations the data do
//                      not determine, and the result of every start
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
  Prediction fitted, held_out;  // for these values
  std::size_t asked = 0;        // evaluations, computed or read from the table
  std::size_t computed = 0;
  double processor_time = 0.0;  // of all evaluations, including earlier ones, s; 0: not measured
};

/// @param folder of the results; its table of evaluations is read and continued
/// @param progress share done, 0…1; also called before each evaluation, and may throw to stop
/// @throws Error(bad_input) if the folder contains another calibration, or if an error of input leaves the model
/// without an answer to the start's own values; Error(physics) if it has no answer anywhere; Error(stopped)
CalibrationResults calibrate(const Calibration& calibration, const std::filesystem::path& folder,
                             const ProgressCall& progress);

/// Calls visit(target, k, index among all points) for every figure.
template <class Visit>
void each_figure(const std::vector<Target>& targets, Visit&& visit) {
  std::size_t at = 0;
  for (const Target& target : targets)
    for (std::size_t k = 0; k < target.y.size(); ++k) visit(target, k, at++);
}

/// not_known: the surrogate's error is larger than twice the target's standard error. reached: within two standard
/// errors of target and surrogate together. out_of_range: outside the range of all evaluations by more than two.
/// not_together: within that range, but not reached together with the other targets.
enum class ReachState { reached, out_of_range, not_together, not_known };
/// @param sigma the target's standard error
ReachState reach_state(const Reach& reach, double data, double sigma);

nlohmann::ordered_json calibration_json(const Calibration& calibration, const CalibrationResults& results);
/// Warnings to read before trusting the result: parameters at bounds, undetermined combinations, differing starts.
std::vector<std::string> calibration_warnings(const Calibration& calibration, const CalibrationResults& results);
/// Writes calibration.json, fit.csv and the fitted file. @throws Error(io)
void write_calibration(const Calibration& calibration, const CalibrationResults& results,
                       const std::filesystem::path& folder);

}  // namespace furrow::calibrate
