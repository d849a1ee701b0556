// How well data determine parameters: standard errors, intervals, and undetermined combinations, from a least-squares
// fit linearised at its end.
//
// With the Jacobian J = ∂r/∂s of the free parameters (s on scales from 0 to 1) and m points, p of them free,
//   σ̂² = Σ r²/(m − p),   cov s = σ̂² (JᵀJ)⁻¹ = σ̂² Σ v v ᵀ/w²                                [Seber & Wild 2003, §2.1]
// w and v are the singular values and right vectors of J. A parameter at a bound is held: it has no error of its own,
// and the others' errors hold for that value. Residuals with a common cause, such as a model's own error, are not
// independent; these intervals are then too narrow.
//
// The data do not determine a combination v if its 95 % interval t σ̂/w is half of the scale or more. The same holds if
// w is below 1e-6 of the largest: then even data without error would not determine it. A parameter whose own interval
// is as wide as its scale on either side has none.
//
// [Seber & Wild 2003] Nonlinear Regression, Wiley.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "nodes/calibrate/kind.hpp"

namespace furrow::calibrate {

enum class Bound { none, lower, upper };

struct Estimate {
  double value = 0.0;  // in the parameter's unit
  Bound at = Bound::none;
  std::optional<double> standard_error;  // in its unit; none: at a bound, or not determined
  std::optional<double> low, high;       // 95 % interval, on a logarithmic scale around the value's logarithm
};

/// A direction of the parameters, on their scales, which the data do not determine.
struct Undetermined {
  std::vector<double> direction;  // of all parameters, of length 1; 0 for those at a bound
  double half_interval = 0.0;     // 95 %, of the scale; infinite: no interval
};

struct Confidence {
  std::vector<Estimate> estimates;      // of all parameters
  std::vector<double> singular_values;  // of J/σ̂ of the free parameters, largest first
  std::vector<Undetermined> undetermined;
  double deviation = 0.0;  // σ̂, in units of the points' σ
  int freedom = 0;         // m − p
};

/// @param place on the scales @param jacobian ∂r/∂share
/// @param known_errors the residuals are divided by their whole standard errors: σ̂ is 1, and the intervals are those
/// of the normal distribution @pre more points than parameters, or known errors
Confidence confidence(std::span<const Parameter> parameters, const Eigen::VectorXd& place,
                      const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian, bool known_errors = false);

/// "0.71 bending − 0.70 shear": the parts above a fiftieth, largest first.
std::string combination_text(std::span<const Parameter> parameters, std::span<const double> direction);

struct Goodness {
  double off = 0.0, total = 0.0;  // Σ(model − data)²/σ², Σ(data − their mean)²/σ²
  double largest_error = 0.0;     // |model − data|, in the unit of the data
  double peak = 0.0;              // largest |data|
  double root_mean_square = 0.0;
  double r_squared() const;  // 1 − off/total; NaN: the data do not vary
};
Goodness goodness(const Target& target, std::span<const double> model);
/// R² of several targets together, each about its own mean, every point divided by its σ.
double joint_r_squared(const std::vector<Target>& targets, std::span<const double> model);

}  // namespace furrow::calibrate
