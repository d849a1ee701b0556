// What an optimizer of calibrations is told and what it finds. A kind names its optimizer (kind.hpp).
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
  int starts = 1;          // the first at the parameters' own start, the others anywhere within the bounds
  std::uint64_t seed = 1;  // of the others
  int evaluations = 0;     // of a noisy model at most
  std::function<void(double share)> progress = {};  // called now and then with what is done, 0…1
};

/// How one start went. Places are on the scales from 0 to 1.
struct StartResult {
  Eigen::VectorXd begin, end;
  std::optional<double> squares;  // Σ r² at the end; none: the model had no answer where it began
  int iterations = 0;
  std::string ended;  // "converged", "out of iterations", or why not
};

/// What a noisy model says of one figure, all in the figure's unit.
struct Reach {
  double value = 0.0, error = 0.0;  // of the surrogate at the place, and its standard error
  double noise = 0.0;               // standard deviation of one evaluation
  double scale = 0.0;               // √(σ² + error²), σ of the target
  double low = 0.0, high = 0.0;     // what the evaluations span
};

struct Optimum {
  std::vector<StartResult> starts;
  Eigen::VectorXd place;      // of the least
  Eigen::VectorXd residuals;  // there
  Eigen::MatrixXd jacobian;   // ∂r/∂share there; of a surrogate where the model is noisy
  double squares = 0.0;       // Σ r² there
  bool known_errors = false;  // r are over the whole standard errors: none is taken from the residuals
  std::vector<Reach> reach;   // of every fitted figure of a noisy model
  int evaluations = 0;        // of a noisy model that were asked for,
  std::string ended = {};     // and why no further one
};

/// For models that answer quickly and without noise (smooth.cpp).
/// @throws Error(stopped) from the objective, Error(physics) where the model answers at none of the starts
Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options);

/// For models that cost much and answer with noise (noisy.cpp). Asks for at most options.evaluations predictions of the
/// fitted targets. The place that it ends at is one of them.
/// @throws Error(stopped) from the objective, Error(physics) where the model answers at too few places
Optimum optimize_noisy(Objective& objective, const OptimizerOptions& options);

}  // namespace furrow::calibrate
