// Minimises a sum of squares on scales from 0 to 1 with Levenberg and Marquardt's method within bounds
// [Ceres Solver 2.1, http://ceres-solver.org].
//
// Ceres projects its steps onto the bounds, which ends near a minimum, but slowly. A second solution begins there. It
// holds parameters at their bound for the next step if the gradient pushes them against it: it leaves out their columns
// of the Jacobian. At its end, the first-order conditions of a minimum under bounds are fulfilled.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include <Eigen/Core>

namespace furrow::calibrate {

/// Residuals at a place and, unless J is null, their derivatives ∂r/∂share. False if there is no answer; may throw.
using Residuals = std::function<bool(const Eigen::VectorXd& place, Eigen::VectorXd& r, Eigen::MatrixXd* J)>;

struct Least {
  Eigen::VectorXd place;
  int iterations = 0;
  std::string ended;  // "converged", "out of iterations", or the reason for another end
};

/// @param points number of residuals @throws what `residuals` throws
Least least_squares(const Residuals& residuals, std::size_t points, Eigen::VectorXd begin);

/// Random numbers from 0 to 1 with the same bits on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  Eigen::VectorXd place(std::size_t size) {
    return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(size),
                                        [this] { return static_cast<double>(bits_() >> 11) * 0x1p-53; });
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace furrow::calibrate
