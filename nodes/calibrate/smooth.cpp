#include "nodes/calibrate/smooth.hpp"

#include <algorithm>
#include <exception>
#include <random>
#include <utility>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "protocol/core/error.hpp"

namespace furrow::calibrate {
namespace {

constexpr int kMostIterations = 200;
constexpr int kMostRounds = 8;       // of holding and letting go
constexpr int kMostDraws = 100;      // for a random start where the model answers
constexpr int kMostPolish = 3;       // undamped steps at the end
constexpr double kAtBound = 1e-9;    // of the scale
constexpr double kTolerance = 1e-9;  // of the sum of squares

/// Residuals for Ceres: every parameter a block of its own, so that each may be held.
class Residuals final : public ceres::CostFunction {
 public:
  explicit Residuals(Objective& objective) : objective_(objective) {
    set_num_residuals(static_cast<int>(objective.points()));
    mutable_parameter_block_sizes()->assign(objective.parameters(), 1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override try {
    if (thrown_) return false;
    std::vector<double> shares;
    for (std::size_t k = 0; k < objective_.parameters(); ++k) shares.push_back(blocks[k][0]);
    const auto r = objective_.residuals(shares);
    if (!r) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, r->size()) = *r;
    if (!jacobians) return true;
    const auto J = objective_.jacobian(shares, *r);
    if (!J) return false;
    for (std::size_t k = 0; k < objective_.parameters(); ++k)
      if (jacobians[k]) Eigen::Map<Eigen::VectorXd>(jacobians[k], r->size()) = J->col(static_cast<Eigen::Index>(k));
    return true;
  } catch (...) {  // not through Ceres
    thrown_ = std::current_exception();
    return false;
  }

  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  Objective& objective_;
  mutable std::exception_ptr thrown_;
};

struct Told final : ceres::IterationCallback {
  std::function<void(int iteration)> tell;
  int before = 0;  // iterations of the start's earlier rounds
  std::exception_ptr thrown;
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override try {
    if (tell) tell(before + summary.iteration);
    return ceres::SOLVER_CONTINUE;
  } catch (...) {  // not through Ceres
    thrown = std::current_exception();
    return ceres::SOLVER_ABORT;
  }
};

/// Pushed against the bound that it lies at: there the sum of squares would fall beyond it.
bool pushed(double share, double gradient) {
  return (share <= kAtBound && gradient > 0.0) || (share >= 1.0 - kAtBound && gradient < 0.0);
}

class Solver {
 public:
  Solver(Objective& objective, std::function<void(int)> tell) : objective_(objective) { told_.tell = std::move(tell); }

  StartResult from(std::vector<double> begin) {
    StartResult result{begin, begin, std::nullopt, 0, ""};
    std::vector<bool> held(begin.size(), false);
    for (int round = 0; round < kMostRounds; ++round) {
      const std::string ended = solve(result.end, held, result.iterations);
      const auto r = objective_.residuals(result.end);
      if (!r) {
        result.ended = "the model has no answer: " + objective_.predict(result.end).problem;
        return result;
      }
      result.squares = r->squaredNorm();
      result.ended = ended;
      const auto J = objective_.jacobian(result.end, *r);
      if (!J) {
        result.ended = "ends where the model has no answer on either side";
        return result;
      }
      const Eigen::VectorXd gradient = J->transpose() * *r;
      std::vector<bool> now(held.size());
      for (std::size_t k = 0; k < now.size(); ++k)
        now[k] = pushed(result.end[k], gradient[static_cast<Eigen::Index>(k)]);
      if (now == held) {
        polish(result, held, *r, *J);
        break;
      }
      held = now;
      if (std::all_of(held.begin(), held.end(), [](bool h) { return h; })) break;
    }
    return result;
  }

 private:
  /// Steps of Gauss and Newton without damping, as long as they make it better: the last
  /// digits that damped steps leave.
  void polish(StartResult& result, const std::vector<bool>& held, Eigen::VectorXd r, Eigen::MatrixXd J) {
    for (int n = 0; n < kMostPolish; ++n) {
      for (std::size_t k = 0; k < held.size(); ++k)
        if (held[k]) J.col(static_cast<Eigen::Index>(k)).setZero();
      const Eigen::VectorXd step = J.completeOrthogonalDecomposition().solve(-r);
      std::vector<double> place = result.end;
      bool inside = true;
      for (std::size_t k = 0; k < place.size(); ++k) {
        if (!held[k]) place[k] += step[static_cast<Eigen::Index>(k)];
        inside = inside && place[k] >= 0.0 && place[k] <= 1.0;
      }
      const auto better = inside ? objective_.residuals(place) : std::nullopt;
      if (!better || !(better->squaredNorm() < *result.squares)) return;
      result.end = place, result.squares = better->squaredNorm();
      const auto next = objective_.jacobian(place, *better);
      if (!next) return;
      r = *better, J = *next;
    }
  }

  std::string solve(std::vector<double>& place, const std::vector<bool>& held, int& iterations) {
    Residuals residuals(objective_);
    ceres::Problem::Options of_problem;
    of_problem.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(of_problem);
    std::vector<double*> blocks;
    for (double& share : place) {
      share = share <= kAtBound ? 0.0 : share >= 1.0 - kAtBound ? 1.0 : share;
      blocks.push_back(&share);
    }
    problem.AddResidualBlock(&residuals, nullptr, blocks);
    for (std::size_t k = 0; k < place.size(); ++k) {
      problem.SetParameterLowerBound(blocks[k], 0, 0.0);
      problem.SetParameterUpperBound(blocks[k], 0, 1.0);
      if (held[k]) problem.SetParameterBlockConstant(blocks[k]);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = kMostIterations;
    options.function_tolerance = kTolerance;
    options.parameter_tolerance = 1e-9;
    options.gradient_tolerance = 1e-12;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.callbacks = {&told_};
    told_.before = iterations;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    residuals.rethrow();
    if (told_.thrown) std::rethrow_exception(told_.thrown);
    iterations += static_cast<int>(summary.iterations.size());
    if (summary.termination_type == ceres::CONVERGENCE) return "converged";
    return summary.termination_type == ceres::NO_CONVERGENCE ? "out of iterations" : "no step makes it better";
  }

  Objective& objective_;
  Told told_;
};

/// Places anywhere within the bounds, on the scales, where the model answers.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  std::vector<double> operator()(Objective& objective) {
    std::vector<double> place(objective.parameters());
    for (int n = 0; n < kMostDraws; ++n) {
      for (double& share : place) share = static_cast<double>(bits_() >> 11) * 0x1p-53;
      if (objective.residuals(place)) break;
    }
    return place;
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace

Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports by its summary; its log is not for users
  Optimum optimum;
  Draw draw(options.seed);
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    const auto tell = [&](int iteration) {
      // Few starts need many iterations: half of a start is done after 20 of them.
      const double part = iteration / (iteration + 20.0);
      if (options.progress) options.progress((k + part) / options.starts);
    };
    std::vector<double> begin = k == 0 ? objective.start() : draw(objective);
    const StartResult result = Solver(objective, tell).from(std::move(begin));
    if (result.squares && *result.squares < best) best = *result.squares, optimum.place = result.end;
    optimum.starts.push_back(result);
  }
  if (optimum.place.empty())
    throw physics_error(fmt::format("{}: the model has no answer at any of the {} starts: {}",
                                    objective.calibration().file.string(), options.starts,
                                    objective.predict(objective.start()).problem));
  const auto r = objective.residuals(optimum.place);
  optimum.residuals = *r;
  optimum.squares = r->squaredNorm();
  const auto J = objective.jacobian(optimum.place, *r);
  if (!J)
    throw physics_error(
        fmt::format("{}: the least lies where the model has no answer on either side: narrower "
                    "bounds are needed",
                    objective.calibration().file.string()));
  optimum.jacobian = *J;
  return optimum;
}

}  // namespace furrow::calibrate
