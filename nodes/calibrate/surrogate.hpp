// A smooth surrogate for one figure of a costly and noisy model, from few evaluations: a Gaussian process with a linear
// trend [Rasmussen & Williams 2006, §2.2 and §2.7]. On scales from 0 to 1,
//   y(s) = β₀ + βᵀs + g(s) + ε,   cov g(s, s′) = τ² exp(−|s − s′|²/2ℓ²),   var ε = ν wᵢ
// with β by generalised least squares. τ, ℓ and the part of ν beyond the model's own errors maximise the restricted
// likelihood [Patterson & Thompson 1971] on a fixed grid: the same evaluations give the same bits. Errors hold for the
// chosen τ, ℓ, ν.
//
// Errors from few beds are themselves uncertain. The variance of an evaluation is therefore the mean of its own and of
// the median of all, which counts twice [Smyth 2004, eq. 5, with 4 and 2 degrees of freedom]. An evaluation that went
// wrong, with an error many times as large as the others', thus hardly counts, and a small error by chance adds little
// weight.
//
// [Rasmussen & Williams 2006] Gaussian Processes for Machine Learning, MIT Press.
// [Patterson & Thompson 1971] Recovery of inter-block information when block sizes are unequal, Biometrika 58.
// [Smyth 2004] Linear models and empirical Bayes methods for assessing differential expression, SAGMB 3.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace furrow::calibrate {

class Surrogate {
 public:
  /// @param places one column for each evaluation, on the scales @param values there, in the figure's unit
  /// @param errors of each value by the model, in the figure's unit; none, 0 or NaN: not known
  /// @pre two evaluations or more
  Surrogate(const Eigen::MatrixXd& places, const Eigen::VectorXd& values, const std::vector<double>& errors = {});

  struct Answer {
    double value = 0.0;        // without noise
    double variance = 0.0;     // of it
    Eigen::VectorXd gradient;  // of the value, by the shares
  };
  Answer at(const Eigen::VectorXd& place) const;
  double noise() const { return noise_; }  // ν, variance of an evaluation whose own error is the median

 private:
  /// Solution for the data with chosen τ, ℓ and ν; all in units of the values' own spread.
  struct State {
    double signal = 0.0, length = 1.0, noise = 0.0;  // τ², ℓ, ν
    double likelihood = 0.0;
    Eigen::LLT<Eigen::MatrixXd> covariance, trend;  // C; HᵀC⁻¹H
    Eigen::MatrixXd weighted;                       // C⁻¹H
    Eigen::VectorXd beta, rest;                     // β; C⁻¹(y − Hβ)
  };
  bool solve(State& state) const;
  Eigen::VectorXd trend_at(const Eigen::VectorXd& place) const;

  Eigen::MatrixXd places_, trend_;  // s; H
  Eigen::VectorXd values_;          // (y − mean)/spread
  Eigen::VectorXd weights_;         // w
  double mean_ = 0.0, spread_ = 1.0, noise_ = 0.0;
  State state_;
};

}  // namespace furrow::calibrate
