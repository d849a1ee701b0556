#include "nodes/calibrate/noisy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "nodes/calibrate/surrogate.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::calibrate {
namespace {

constexpr int kDesigns = 300;   // Latin hypercubes that the best is chosen from
constexpr int kRounds = 3;      // of the weights, which depend on the place
constexpr int kLooks = 400;     // places among which the least certain one is looked for
constexpr double kSame = 0.01;  // of a scale: two places that tell the same
constexpr double kStays = 0.3;  // of a parameter's standard error: the least stays where it is
constexpr double kNear = 0.15;  // of a scale: around the least

using Places = std::vector<Eigen::VectorXd>;

/// Numbers from 0 to 1 with the same bits everywhere.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  Eigen::VectorXd place(Eigen::Index size) {
    Eigen::VectorXd s(size);
    for (double& share : s) share = (*this)();
    return s;
  }
  /// 0 … count − 1 in any order.
  std::vector<int> order(int count) {
    std::vector<int> list(static_cast<std::size_t>(count));
    std::iota(list.begin(), list.end(), 0);
    for (int k = count - 1; k > 0; --k)
      std::swap(list[static_cast<std::size_t>(k)], list[static_cast<std::size_t>((*this)() * (k + 1))]);
    return list;
  }

 private:
  std::mt19937_64 bits_;
};

double least_distance(const Places& places) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (places[i] - places[j]).norm());
  return least;
}

/// The start and `count` places that fill the scales.
Places design(const Eigen::VectorXd& start, int count, Draw& draw) {
  Places best;
  double farthest = -1.0;
  for (int n = 0; n < kDesigns; ++n) {
    Places places(static_cast<std::size_t>(count), Eigen::VectorXd(start.size()));
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      const std::vector<int> order = draw.order(count);
      for (std::size_t i = 0; i < places.size(); ++i) places[i][k] = (order[i] + 0.5) / count;
    }
    places.insert(places.begin(), start);
    if (const double least = least_distance(places); least > farthest) farthest = least, best = std::move(places);
  }
  return best;
}

/// The surrogates of all figures beside the data.
class Misfit {
 public:
  Misfit(const Calibration& calibration, const Places& places, const std::vector<Prediction>& found) {
    for (const Target& target : calibration.model->targets(TargetSet::fitted)) {
      data_.insert(data_.end(), target.y.begin(), target.y.end());
      sigma_.insert(sigma_.end(), target.sigma.begin(), target.sigma.end());
    }
    Eigen::MatrixXd at(places.front().size(), static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) at.col(static_cast<Eigen::Index>(i)) = places[i];
    for (std::size_t q = 0; q < data_.size(); ++q) {
      Eigen::VectorXd values(at.cols());
      std::vector<double> errors;
      for (std::size_t i = 0; i < places.size(); ++i) {
        values[static_cast<Eigen::Index>(i)] = found[i].values[q];
        errors.push_back(found[i].errors.empty() ? NAN : found[i].errors[q]);
      }
      surrogates_.emplace_back(at, values, errors);
    }
    weigh(places.front());
  }

  std::size_t points() const { return data_.size(); }
  const Surrogate& surrogate(std::size_t q) const { return surrogates_[q]; }
  double data(std::size_t q) const { return data_[q]; }
  /// √(σ² + σ̂²) of a figure, where the weights were last taken.
  double scale(std::size_t q) const { return scale_[q]; }

  void weigh(const Eigen::VectorXd& place) {
    scale_.resize(points());
    for (std::size_t q = 0; q < points(); ++q)
      scale_[q] = std::sqrt(sigma_[q] * sigma_[q] + surrogates_[q].at(place).variance);
  }
  void residuals(const Eigen::VectorXd& place, Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
    r.resize(static_cast<Eigen::Index>(points())), J.resize(r.size(), place.size());
    for (std::size_t q = 0; q < points(); ++q) {
      const Surrogate::Answer answer = surrogates_[q].at(place);
      r[static_cast<Eigen::Index>(q)] = (answer.value - data_[q]) / scale_[q];
      J.row(static_cast<Eigen::Index>(q)) = answer.gradient.transpose() / scale_[q];
    }
  }
  double squares(const Eigen::VectorXd& place) const {
    double sum = 0.0;
    for (std::size_t q = 0; q < points(); ++q) {
      const double r = (surrogates_[q].at(place).value - data_[q]) / scale_[q];
      sum += r * r;
    }
    return sum;
  }
  /// Whether no surrogate errs by more than its target there.
  bool known(const Eigen::VectorXd& place) const {
    for (std::size_t q = 0; q < points(); ++q)
      if (surrogates_[q].at(place).variance > sigma_[q] * sigma_[q]) return false;
    return true;
  }
  /// How little is known at a place: the surrogates' variances over those of the targets.
  double doubt(const Eigen::VectorXd& place) const {
    double sum = 0.0;
    for (std::size_t q = 0; q < points(); ++q) sum += surrogates_[q].at(place).variance / (sigma_[q] * sigma_[q]);
    return sum;
  }

 private:
  std::vector<double> data_, sigma_, scale_;
  std::vector<Surrogate> surrogates_;
};

/// For Ceres; the places are one block.
class Cost final : public ceres::CostFunction {
 public:
  Cost(const Misfit& misfit, Eigen::Index size) : misfit_(misfit), size_(size) {
    set_num_residuals(static_cast<int>(misfit.points()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    misfit_.residuals(Eigen::Map<const Eigen::VectorXd>(blocks[0], size_), r, J);
    std::copy(r.begin(), r.end(), residuals);
    if (!jacobians || !jacobians[0]) return true;
    for (Eigen::Index q = 0; q < J.rows(); ++q)
      for (Eigen::Index k = 0; k < size_; ++k) jacobians[0][q * size_ + k] = J(q, k);
    return true;
  }

 private:
  const Misfit& misfit_;
  Eigen::Index size_;
};

struct Least {
  Eigen::VectorXd place;
  double squares = std::numeric_limits<double>::infinity();
  int iterations = 0;
};

Least least_from(const Misfit& misfit, Eigen::VectorXd place) {
  ceres::Problem problem;
  problem.AddResidualBlock(new Cost(misfit, place.size()), nullptr, place.data());
  for (int k = 0; k < static_cast<int>(place.size()); ++k) {
    problem.SetParameterLowerBound(place.data(), k, 0.0);
    problem.SetParameterUpperBound(place.data(), k, 1.0);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {place, misfit.squares(place), static_cast<int>(summary.iterations.size())};
}

class Noisy {
 public:
  Noisy(Objective& objective, const OptimizerOptions& options)
      : objective_(objective),
        options_(options),
        draw_(options.seed),
        size_(static_cast<Eigen::Index>(objective.parameters())) {}

  Optimum run() {
    const std::vector<double> start = objective_.start();
    const int count = std::min(3 * static_cast<int>(size_), options_.evaluations - 3);
    for (const Eigen::VectorXd& place : design(Eigen::Map<const Eigen::VectorXd>(start.data(), size_), count, draw_))
      evaluate(place);
    require_answers();
    Eigen::VectorXd before;  // the least before this one
    std::string ended;
    for (;;) {
      Misfit misfit = fit();
      Least least = minimise(misfit, before);
      if (options_.progress) options_.progress(share());
      if (before.size() > 0 && stays(misfit, before, least.place) && misfit.known(least.place))
        ended = "converged";
      else if (asked_ >= options_.evaluations)
        ended = "all evaluations are used";
      if (!ended.empty()) return result(misfit, ended);
      // Where the least is known already, what is around it tells more.
      const bool known = distance(least.place) < kSame;
      const bool answered = evaluate(known ? least_certain(misfit, least.place) : least.place);
      before = known || answered ? least.place : Eigen::VectorXd();
    }
  }

 private:
  double share() const { return static_cast<double>(asked_) / options_.evaluations; }
  static std::vector<double> list(const Eigen::VectorXd& place) { return {place.begin(), place.end()}; }

  /// @returns whether the model has an answer
  bool evaluate(const Eigen::VectorXd& place) {
    if (options_.progress) options_.progress(share());
    const Prediction& found = objective_.predict(list(place));
    ++asked_;
    all_.push_back(place);
    if (!found.problem.empty()) {
      problem_ = found.problem;
      return false;
    }
    places_.push_back(place), found_.push_back(found);
    return true;
  }

  void require_answers() const {
    const std::size_t least = static_cast<std::size_t>(size_) + 2;
    if (places_.size() < least)
      throw physics_error(
          fmt::format("{}: the model answers at {} of the {} places of the design, expected {} or more; "
                      "where it does not: {}",
                      objective_.calibration().file.string(), places_.size(), all_.size(), least, problem_));
  }

  Misfit fit() const { return Misfit(objective_.calibration(), places_, found_); }

  /// Of all that was asked for.
  double distance(const Eigen::VectorXd& place) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& other : all_) least = std::min(least, (place - other).cwiseAbs().maxCoeff());
    return least;
  }

  /// The evaluation where the surrogates' misfit is least.
  const Eigen::VectorXd& best_of(const Misfit& misfit) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < places_.size(); ++i)
      if (misfit.squares(places_[i]) < misfit.squares(places_[best])) best = i;
    return places_[best];
  }

  Least minimise(Misfit& misfit, const Eigen::VectorXd& before) {
    Least least;
    starts_.clear();
    Eigen::VectorXd weighed = before.size() > 0 ? before : best_of(misfit);
    Draw draw(options_.seed);  // the same starts each time
    std::vector<Eigen::VectorXd> begins{weighed};
    while (static_cast<int>(begins.size()) < options_.starts) begins.push_back(draw.place(size_));
    for (int round = 0; round < kRounds; ++round) {
      misfit.weigh(weighed);
      least = {};
      starts_.clear();
      for (const Eigen::VectorXd& begin : begins) {
        Least one = least_from(misfit, begin);
        starts_.push_back({list(begin), list(one.place), one.squares, one.iterations, "on the surrogates"});
        if (one.squares < least.squares) least = std::move(one);
      }
      weighed = least.place;
    }
    return least;
  }

  /// Whether the least moved by less than a part of its standard errors.
  static bool stays(const Misfit& misfit, const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    misfit.residuals(now, r, J);
    // Directions that nothing determines end at the scale's own length.
    const Eigen::MatrixXd JtJ = J.transpose() * J + Eigen::MatrixXd::Identity(now.size(), now.size());
    const Eigen::MatrixXd covariance = JtJ.inverse();
    for (Eigen::Index k = 0; k < now.size(); ++k)
      if (std::abs(now[k] - before[k]) > std::max(kSame, kStays * std::sqrt(covariance(k, k)))) return false;
    return true;
  }

  /// Near the least, where the surrogates know least.
  Eigen::VectorXd least_certain(const Misfit& misfit, const Eigen::VectorXd& around) {
    Eigen::VectorXd best = draw_.place(size_);
    double most = -1.0;
    for (int n = 0; n < kLooks; ++n) {
      Eigen::VectorXd place = around + kNear * (2.0 * draw_.place(size_).array() - 1.0).matrix();
      place = place.cwiseMax(0.0).cwiseMin(1.0);
      if (distance(place) < kSame) continue;
      if (const double doubt = misfit.doubt(place); doubt > most) most = doubt, best = place;
    }
    return best;
  }

  Optimum result(Misfit& misfit, const std::string& ended) {
    const Eigen::VectorXd place = best_of(misfit);
    misfit.weigh(place);
    Optimum optimum;
    optimum.starts = starts_;
    optimum.place = list(place);
    misfit.residuals(place, optimum.residuals, optimum.jacobian);
    optimum.squares = optimum.residuals.squaredNorm();
    optimum.known_errors = true;
    optimum.evaluations = asked_;
    optimum.ended = ended;
    for (std::size_t q = 0; q < misfit.points(); ++q) {
      const Surrogate::Answer answer = misfit.surrogate(q).at(place);
      Reach reach{answer.value,    std::sqrt(answer.variance), std::sqrt(misfit.surrogate(q).noise()),
                  misfit.scale(q), found_.front().values[q],   found_.front().values[q]};
      for (const Prediction& found : found_)
        reach.low = std::min(reach.low, found.values[q]), reach.high = std::max(reach.high, found.values[q]);
      optimum.reach.push_back(reach);
    }
    return optimum;
  }

  Objective& objective_;
  const OptimizerOptions& options_;
  Draw draw_;
  Eigen::Index size_;
  int asked_ = 0;
  Places all_, places_;            // asked for; with an answer
  std::vector<Prediction> found_;  // at places_
  std::string problem_;
  std::vector<StartResult> starts_;
};

}  // namespace

Optimum optimize_noisy(Objective& objective, const OptimizerOptions& options) {
  FURROW_ASSERT(options.evaluations >= least_evaluations(objective.parameters()), options.evaluations);
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports by its summary; its log is not for users
  return Noisy(objective, options).run();
}

}  // namespace furrow::calibrate
