// Options and results of an optimizer of calibrations. A kind names its optimizer (kind.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace furrow::calibrate {

class Objective;

struct OptimizerOptions {
  int starts = 1;          // the first at the parameters' own start, the others at random within the bounds
  std::uint64_t seed = 1;  // of the random starts
  int evaluations = 0;     // of a noisy model, at most
  std::function<void(double share)> progress = {};  // called now and then with the share done, 0…1
};

/// Result of one start. Places are on the scales from 0 to 1.
struct StartResult {
  Eigen::VectorXd begin, end;
  std::optional<double> squares;  // Σ r² at the end; none: the model had no answer at its beginning
  int iterations = 0;
  std::string ended;  // "converged", "out of iterations", or the reason for another end
};

/// Figure of a noisy model, all in the figure's unit.
struct Reach {
  double value = 0.0, error = 0.0;  // of the surrogate at the place, and its standard error
  double noise = 0.0;               // standard deviation of one evaluation
  double scale = 0.0;               // √(σ² + error²), σ of the target
  double low = 0.0, high = 0.0;     // range of the evaluations
};

struct Optimum {
  std::vector<StartResult> starts;
  Eigen::VectorXd place;      // of the minimum
  Eigen::VectorXd residuals;  // there
  Eigen::MatrixXd jacobian;   // ∂r/∂share there; of a surrogate if the model is noisy
  double squares = 0.0;       // Σ r² there
  bool known_errors = false;  // r are divided by the whole standard errors, so the residuals give no error
  std::vector<Reach> reach;   // of every fitted figure of a noisy model
  int evaluations = 0;        // evaluations of a noisy model
  std::string ended = {};     // why they ended
};

/// For models that answer quickly and without noise (smooth.cpp).
/// @throws Error(stopped) from the objective, Error(physics) if the model answers at none of the starts
Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options);

/// For costly and noisy models (noisy.cpp). Asks for at most options.evaluations predictions of the fitted targets. The
/// final place is one of them.
/// @throws Error(stopped) from the objective, Error(physics) if the model answers at too few places
Optimum optimize_noisy(Objective& objective, const OptimizerOptions& options);

}  // namespace furrow::calibrate
