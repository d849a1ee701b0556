// What a calibration makes small: the sum of squares of the residuals r = (model − data)/σ over all points of the
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
  /// @param progress may throw Error(stopped): the evaluation under way is given up, and not kept
  Objective(const Calibration& calibration, EvaluationTable& table, ProgressCall progress);

  std::size_t parameters() const { return calibration_.parameters.size(); }
  std::size_t points() const { return static_cast<std::size_t>(data_.size()); }
  const Calibration& calibration() const { return calibration_; }
  /// Of all points of the fitted targets, with their standard errors.
  const Eigen::VectorXd& data() const { return data_; }
  const Eigen::VectorXd& sigma() const { return sigma_; }
  /// Evaluations asked for so far, of which `computed()` were not in the table.
  std::size_t asked() const { return asked_; }
  std::size_t computed() const { return computed_; }

  /// In the parameters' units.
  std::vector<double> values(const Eigen::VectorXd& place) const;
  /// On the scales.
  Eigen::VectorXd start() const;

  /// What the model says, from the table where it is known. The reference holds until the next call.
  const Prediction& predict(const Eigen::VectorXd& place, TargetSet set = TargetSet::fitted);
  /// r of all points; none where the model has no answer.
  std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& place);
  /// ∂r/∂share: central differences, one-sided of second order where a bound or a model without an answer is near.
  /// @param at r here @returns none where differences are not to be had
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
