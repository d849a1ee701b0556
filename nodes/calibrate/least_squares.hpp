// The least of a sum of squares on scales from 0 to 1: Levenberg and Marquardt's method within bounds
// [Ceres Solver 2.1, http://ceres-solver.org].
//
// Ceres projects its steps onto the bounds, which ends near a least, but slowly. A second solution begins there. In it,
// parameters that the gradient pushes against the bound that they lie at are held for the next step: their columns of
// the Jacobian are left out. Where it ends, the first-order conditions of a least under bounds are fulfilled.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include <Eigen/Core>

namespace furrow::calibrate {

/// Residuals at a place and, unless J is null, their derivatives ∂r/∂share. False where there is no answer; may throw.
using Residuals = std::function<bool(const Eigen::VectorXd& place, Eigen::VectorXd& r, Eigen::MatrixXd* J)>;

struct Least {
  Eigen::VectorXd place;
  int iterations = 0;
  std::string ended;  // "converged", "out of iterations", or why not
};

/// @param points number of residuals @throws what `residuals` throws
Least least_squares(const Residuals& residuals, std::size_t points, Eigen::VectorXd begin);

/// Numbers from 0 to 1 with the same bits everywhere.
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
