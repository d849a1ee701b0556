// The objective of a calibration: the sum of squares of the residuals r = (model − data)/σ over all points of the
// fitted targets, as a function of the parameters on their scales from 0 to 1 (kind.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "nodes/calibrate/evaluations.hpp"
#include "nodes/calibrate/study.hpp"

namespace furrow::calibrate {

class Objective {
 public:
  /// @param progress may throw Error(stopped): the current evaluation is then dropped
  Objective(const Calibration& calibration, EvaluationTable& table, ProgressCall progress);

  std::size_t parameters() const { return calibration_.parameters.size(); }
  std::size_t points() const { return static_cast<std::size_t>(data_.size()); }
  const Calibration& calibration() const { return calibration_; }
  const Eigen::VectorXd& data() const { return data_; }
  const Eigen::VectorXd& sigma() const { return sigma_; }
  /// Number of evaluations asked for so far; `computed()` of them were not in the table.
  std::size_t asked() const { return asked_; }
  std::size_t computed() const { return computed_; }

  /// Values in the parameters' units.
  std::vector<double> values(const Eigen::VectorXd& place) const;
  /// Start on the scales.
  Eigen::VectorXd start() const;

  /// Returns the model's prediction, from the table if it is there. The reference is valid until the next call.
  const Prediction& predict(const Eigen::VectorXd& place, TargetSet set = TargetSet::fitted);
  /// r of all points; none if the model has no answer.
  std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& place);
  /// ∂r/∂share: central differences; one-sided ones of second order near a bound or a place without an answer.
  /// @param at r here @returns none if no differences can be computed
  std::optional<Eigen::MatrixXd> jacobian(const Eigen::VectorXd& place, const Eigen::VectorXd& at);

  /// Step of the differences, of a scale.
  static constexpr double kDifference = 1e-4;

 private:
  const Calibration& calibration_;
  EvaluationTable& table_;
  ProgressCall progress_;
  std::string held_out_state_;
  Eigen::VectorXd data_, sigma_;
  std::size_t asked_ = 0, computed_ = 0;
};

}  // namespace furrow::calibrate
