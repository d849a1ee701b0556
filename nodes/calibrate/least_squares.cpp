#include "nodes/calibrate/least_squares.hpp"

#include <exception>

#include <ceres/ceres.h>
#include <glog/logging.h>

namespace furrow::calibrate {
namespace {

constexpr int kMostIterations = 200;
constexpr double kStartsAtBound = 1e-9;  // of the scale

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Cost final : public ceres::CostFunction {
 public:
  Cost(const Residuals& residuals, std::size_t points, Eigen::Index size) : residuals_(residuals), size_(size) {
    set_num_residuals(static_cast<int>(points));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override try {
    const bool derived = jacobians && jacobians[0];
    const Eigen::VectorXd place = Eigen::Map<const Eigen::VectorXd>(blocks[0], size_);
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    if (thrown || !residuals_(place, r, derived ? &J : nullptr)) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
    if (!derived) return true;
    for (Eigen::Index k = 0; k < size_; ++k) {
      const double slope = J.col(k).dot(r);
      if (holds && ((place[k] == 0.0 && slope > 0.0) || (place[k] == 1.0 && slope < 0.0))) J.col(k).setZero();
    }
    Eigen::Map<RowMajor>(jacobians[0], J.rows(), J.cols()) = J;
    return true;
  } catch (...) {  // must not pass through Ceres
    thrown = std::current_exception();
    return false;
  }

  bool holds = false;
  mutable std::exception_ptr thrown;

 private:
  const Residuals& residuals_;
  Eigen::Index size_;
};

}  // namespace

Least least_squares(const Residuals& residuals, std::size_t points, Eigen::VectorXd begin) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports by its summary; its log is not for users
  for (double& share : begin) share = share <= kStartsAtBound ? 0.0 : share >= 1.0 - kStartsAtBound ? 1.0 : share;
  Cost cost(residuals, points, begin.size());
  ceres::Problem::Options of_problem;
  of_problem.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(of_problem);
  problem.AddResidualBlock(&cost, nullptr, begin.data());
  for (int k = 0; k < static_cast<int>(begin.size()); ++k) {
    problem.SetParameterLowerBound(begin.data(), k, 0.0);
    problem.SetParameterUpperBound(begin.data(), k, 1.0);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMostIterations;
  options.parameter_tolerance = 1e-9;
  options.gradient_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  int iterations = 0;
  for (const bool holds : {false, true}) {
    cost.holds = holds;
    options.function_tolerance = holds ? 1e-14 : 1e-9;
    ceres::Solve(options, &problem, &summary);
    if (cost.thrown) std::rethrow_exception(cost.thrown);
    iterations += static_cast<int>(summary.iterations.size());
  }
  return {begin, iterations,
          summary.termination_type == ceres::CONVERGENCE      ? "converged"
          : summary.termination_type == ceres::NO_CONVERGENCE ? "out of iterations"
                                                              : "no step makes it better"};
}

}  // namespace furrow::calibrate
