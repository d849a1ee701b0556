#include "nodes/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "nodes/calibrate/objective.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/digits.hpp"

namespace furrow::calibrate {
namespace {

constexpr double kWithin = 2.0;  // standard errors
constexpr double kLeastRSquared = 0.5;
constexpr double kLittleError = 0.1;  // of the peak; for smaller errors R² means little, as the data hardly vary

/// Warns of each figure that was not reached, with the reached range.
std::vector<std::string> reach_warnings(const std::vector<Target>& fitted, const std::vector<Reach>& reach) {
  std::vector<std::string> warnings;
  each_figure(fitted, [&](const Target& target, std::size_t k, std::size_t at) {
    const Reach& r = reach[at];
    const ReachState state = reach_state(r, target.y[k], target.sigma[k]);
    if (state == ReachState::reached) return;
    if (state == ReachState::not_known) {
      warnings.push_back(
          fmt::format("whether {} of {} is reached is not known: {}, expected an error of {} at most; more beds "
                      "('seeds') or evaluations, or closer bounds tell more",
                      target.name, with_error(target.y[k], target.sigma[k]), with_error(r.value, r.error),
                      digits(kWithin * target.sigma[k])));
      return;
    }
    warnings.push_back(fmt::format("{} of {} is not reached but {}: {} ({} to {})", target.name,
                                   with_error(target.y[k], target.sigma[k]), with_error(r.value, r.error),
                                   state == ReachState::out_of_range
                                       ? "it is beyond all evaluations within these bounds"
                                       : "the evaluations span it, but not where the other targets are met",
                                   digits(r.low), digits(r.high)));
  });
  return warnings;
}

/// Warns of curves and tables that the fitted model does not describe.
std::vector<std::string> misfit_warnings(const std::vector<Target>& targets, const Prediction& fitted) {
  std::vector<std::string> warnings;
  std::span<const double> rest = fitted.values;
  for (const Target& target : targets) {
    const Goodness g = goodness(target, rest.first(target.y.size()));
    rest = rest.subspan(target.y.size());
    if (target.y.size() == 1 || !(g.r_squared() < kLeastRSquared) || g.largest_error < kLittleError * g.peak) continue;
    warnings.push_back(
        fmt::format("the fitted model does not describe {} (R² {:.2g}): check the units of {}, and whether its other "
                    "keys are those of the test",
                    target.name, g.r_squared(), target.data.filename().string()));
  }
  return warnings;
}

}  // namespace

ReachState reach_state(const Reach& r, double data, double sigma) {
  if (r.error > kWithin * sigma) return ReachState::not_known;
  if (std::abs(r.value - data) <= kWithin * r.scale) return ReachState::reached;
  const bool beyond = data > r.high + kWithin * r.scale || data < r.low - kWithin * r.scale;
  return beyond ? ReachState::out_of_range : ReachState::not_together;
}

CalibrationResults calibrate(const Calibration& calibration, const std::filesystem::path& folder,
                             const ProgressCall& progress) {
  std::vector<std::string> names;
  for (const Parameter& p : calibration.parameters) names.push_back(p.name);
  EvaluationTable table(folder, calibration.digest, names);
  double share = 0.0;
  // An evaluation of a noisy model takes minutes, so its own progress counts.
  const double evaluation = calibration.kind->noisy ? 1.0 / calibration.evaluations : 0.0;
  const auto tell = [&](const std::string&, double done) {
    if (progress) progress("calibrating", std::min(share + evaluation * done, 1.0));
  };
  Objective objective(calibration, table, tell);
  const OptimizerOptions options{calibration.starts, calibration.seed, calibration.evaluations, [&](double done) {
                                   share = done;
                                   tell("", 0.0);
                                 }};
  CalibrationResults results;
  results.optimum = calibration.kind->optimize(objective, options);
  const Eigen::VectorXd& place = results.optimum.place;
  results.confidence = confidence(calibration.parameters, place, results.optimum.residuals, results.optimum.jacobian,
                                  results.optimum.known_errors);
  results.values = objective.values(place);
  results.fitted = objective.predict(place);
  if (!calibration.model->targets(TargetSet::held_out).empty())
    results.held_out = objective.predict(place, TargetSet::held_out);
  results.asked = objective.asked(), results.computed = objective.computed();
  results.processor_time = table.processor_time();
  return results;
}

std::vector<std::string> calibration_warnings(const Calibration& calibration, const CalibrationResults& results) {
  std::vector<std::string> warnings = calibration.model->notes();
  const std::vector<Target>& fitted = calibration.model->targets(TargetSet::fitted);
  const std::vector<std::string> missed = results.optimum.reach.empty() ? misfit_warnings(fitted, results.fitted)
                                                                        : reach_warnings(fitted, results.optimum.reach);
  warnings.insert(warnings.end(), missed.begin(), missed.end());
  const Confidence& c = results.confidence;
  for (std::size_t k = 0; k < calibration.parameters.size(); ++k) {
    const Parameter& p = calibration.parameters[k];
    if (c.estimates[k].at == Bound::none) continue;
    warnings.push_back(
        fmt::format("{} ends at its {} bound of {}{}: its error is not known, and the data ask for a value beyond it "
                    "or do not determine it",
                    p.name, c.estimates[k].at == Bound::lower ? "lower" : "upper", digits(c.estimates[k].value),
                    p.unit == "-" ? "" : " " + p.unit));
  }
  for (const Undetermined& u : c.undetermined)
    warnings.push_back(fmt::format(
        "the data do not determine {} (each on its scale from lower to upper): its 95 % interval is {}",
        combination_text(calibration.parameters, u.direction),
        std::isfinite(u.half_interval) ? fmt::format("± {:.2g} of the scale", u.half_interval) : "without limit"));
  if (const std::string& problem = results.held_out.problem; !problem.empty())
    warnings.push_back("the fitted model has no answer to the held-out targets: " + problem);
  return warnings;
}

}  // namespace furrow::calibrate
