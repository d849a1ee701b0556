// The optimizer for costly and noisy models: a space-filling design, a surrogate of every figure (surrogate.hpp), and
// evaluations at the minimum of the surrogates' misfit. It ends when that minimum stays in place and the surrogates'
// errors there are smaller than the targets'.
//
// The design is the start and a sequence of low discrepancy with three times as many places as parameters, from a
// random place that depends on the seed [Roberts 2018]. Each figure has its own surrogate. The misfit is Σ (ŷ −
// data)²/(σ² + σ̂²) with the standard errors σ of the target and σ̂ of the surrogate; it is minimised from several
// starts. Both errors are known, so the residuals give none: cov s = (JᵀJ)⁻¹.
//
// [Roberts 2018] The unreasonable effectiveness of quasirandom sequences,
// https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "nodes/calibrate/least_squares.hpp"
#include "nodes/calibrate/objective.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/calibrate/surrogate.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::calibrate {
namespace {

constexpr int kRounds = 3;           // of the weights, which depend on the place
constexpr int kLooks = 400;          // random places among which the least certain one is chosen
constexpr double kSamePlace = 0.01;  // of a scale: two places with the same information
constexpr double kStays = 0.3;       // of a parameter's standard error: the minimum stays in place
constexpr double kNear = 0.15;       // of a scale: around the minimum

using Places = std::vector<Eigen::VectorXd>;

/// Place n of a sequence that fills the scales evenly from a random first place: sᵢ = sᵢ₀ + n g⁻ⁱ modulo 1, with gᵖ⁺¹ =
/// g + 1 for p parameters [Roberts 2018].
Eigen::VectorXd even_place(const Eigen::VectorXd& first, int n) {
  double g = 2.0;
  for (int k = 0; k < 60; ++k) g = std::pow(1.0 + g, 1.0 / (static_cast<double>(first.size()) + 1.0));
  Eigen::VectorXd place = first;
  for (Eigen::Index i = 0; i < place.size(); ++i) {
    const double share = first[i] + n * std::pow(g, -static_cast<double>(i + 1));
    place[i] = share - std::floor(share);
  }
  return place;
}

class Misfit {
 public:
  Misfit(const Objective& objective, const Places& places, const std::vector<Prediction>& found)
      : data_(objective.data()), sigma_(objective.sigma()) {
    Eigen::MatrixXd at(places.front().size(), static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) at.col(static_cast<Eigen::Index>(i)) = places[i];
    for (std::size_t q = 0; q < objective.points(); ++q) {
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

  const std::vector<Surrogate>& surrogates() const { return surrogates_; }
  /// √(σ² + σ̂²) of each figure at the place where the weights were last computed.
  const Eigen::VectorXd& scale() const { return scale_; }

  void weigh(const Eigen::VectorXd& place) { scale_ = sigma_.array() * (1.0 + doubts(place).array()).sqrt(); }
  bool residuals(const Eigen::VectorXd& place, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    r.resize(data_.size());
    if (J) J->resize(r.size(), place.size());
    for (Eigen::Index q = 0; q < r.size(); ++q) {
      const Surrogate::Answer answer = surrogates_[static_cast<std::size_t>(q)].at(place);
      r[q] = (answer.value - data_[q]) / scale_[q];
      if (J) J->row(q) = answer.gradient.transpose() / scale_[q];
    }
    return true;
  }
  double squares(const Eigen::VectorXd& place) const {
    Eigen::VectorXd r;
    residuals(place, r, nullptr);
    return r.squaredNorm();
  }
  /// Uncertainty of each figure at a place: the surrogate's variance over that of the target.
  Eigen::VectorXd doubts(const Eigen::VectorXd& place) const {
    Eigen::VectorXd doubts(data_.size());
    for (Eigen::Index q = 0; q < doubts.size(); ++q)
      doubts[q] = surrogates_[static_cast<std::size_t>(q)].at(place).variance / (sigma_[q] * sigma_[q]);
    return doubts;
  }

 private:
  const Eigen::VectorXd &data_, &sigma_;  // the objective's
  Eigen::VectorXd scale_;
  std::vector<Surrogate> surrogates_;
};

class Noisy {
 public:
  Noisy(Objective& objective, const OptimizerOptions& options)
      : objective_(objective), options_(options), draw_(options.seed) {}

  Optimum run() {
    const int count = std::min(3 * static_cast<int>(objective_.parameters()), options_.evaluations - 3);
    const Eigen::VectorXd first = draw_.place(objective_.parameters());
    evaluate(objective_.start());
    for (int n = 0; n < count; ++n) evaluate(even_place(first, n));
    require_answers();
    Eigen::VectorXd before;  // the previous minimum
    for (;;) {
      Misfit misfit(objective_, places_, found_);
      const Eigen::VectorXd least = minimise(misfit, before);
      if (before.size() > 0 && stays(misfit, before, least) && misfit.doubts(least).maxCoeff() <= 1.0)
        return result(misfit, "converged");
      if (asked() >= options_.evaluations) return result(misfit, "all evaluations are used");
      // If the minimum was already evaluated, a place near it adds more information.
      const bool known = distance(least) < kSamePlace;
      const bool answered = evaluate(known ? least_certain(misfit, least) : least);
      before = known || answered ? least : Eigen::VectorXd();
    }
  }

 private:
  int asked() const { return static_cast<int>(all_.size()); }

  /// @returns whether the model has an answer
  bool evaluate(const Eigen::VectorXd& place) {
    const auto tell = [&] {
      if (options_.progress) options_.progress(static_cast<double>(asked()) / options_.evaluations);
    };
    tell();
    const Prediction& found = objective_.predict(place);
    all_.push_back(place);
    tell();
    if (!found.problem.empty()) {
      problem_ = found.problem;
      return false;
    }
    places_.push_back(place), found_.push_back(found);
    return true;
  }

  void require_answers() const {
    const std::size_t least = objective_.parameters() + 2;
    if (places_.size() < least)
      throw physics_error(
          "{}: the model answers at {} of the {} places of the design, expected {} or more; where it does not: {}",
          objective_.calibration().file.string(), places_.size(), all_.size(), least, problem_);
  }

  /// Distance to the nearest evaluated place.
  double distance(const Eigen::VectorXd& place) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& other : all_) least = std::min(least, (place - other).cwiseAbs().maxCoeff());
    return least;
  }

  /// Returns the evaluated place with the smallest misfit of the surrogates.
  const Eigen::VectorXd& best_of(const Misfit& misfit) const {
    return *std::min_element(places_.begin(), places_.end(), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return misfit.squares(a) < misfit.squares(b);
    });
  }

  Eigen::VectorXd minimise(Misfit& misfit, const Eigen::VectorXd& before) {
    Eigen::VectorXd least = before.size() > 0 ? before : best_of(misfit);
    Draw draw(options_.seed);  // the same starts each time
    Places begins{least};
    while (static_cast<int>(begins.size()) < options_.starts) begins.push_back(draw.place(objective_.parameters()));
    const Residuals residuals = [&](const auto& place, auto& r, auto* J) { return misfit.residuals(place, r, J); };
    for (int round = 0; round < kRounds; ++round) {
      misfit.weigh(least);
      double squares = std::numeric_limits<double>::infinity();
      starts_.clear();
      for (const Eigen::VectorXd& begin : begins) {
        const Least one = least_squares(residuals, objective_.points(), begin);
        starts_.push_back({begin, one.place, misfit.squares(one.place), one.iterations, "on the surrogates"});
        if (*starts_.back().squares < squares) squares = *starts_.back().squares, least = one.place;
      }
    }
    return least;
  }

  /// Checks whether the minimum moved by less than a fraction of its standard errors.
  static bool stays(const Misfit& misfit, const Eigen::VectorXd& before, const Eigen::VectorXd& now) {
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    misfit.residuals(now, r, &J);
    // The identity limits the errors of undetermined directions to the scale's own length.
    const Eigen::MatrixXd JtJ = J.transpose() * J + Eigen::MatrixXd::Identity(now.size(), now.size());
    const Eigen::ArrayXd errors = JtJ.inverse().diagonal().array().sqrt();
    return ((now - before).array().abs() <= (kStays * errors).max(kSamePlace)).all();
  }

  /// Returns a place near the minimum where the surrogates are least certain.
  Eigen::VectorXd least_certain(const Misfit& misfit, const Eigen::VectorXd& around) {
    Eigen::VectorXd best = draw_.place(objective_.parameters());
    double most = -1.0;
    for (int n = 0; n < kLooks; ++n) {
      Eigen::VectorXd place = around + kNear * (2.0 * draw_.place(objective_.parameters()).array() - 1.0).matrix();
      place = place.cwiseMax(0.0).cwiseMin(1.0);
      if (distance(place) < kSamePlace) continue;
      if (const double doubt = misfit.doubts(place).sum(); doubt > most) most = doubt, best = place;
    }
    return best;
  }

  Optimum result(Misfit& misfit, const std::string& ended) {
    Optimum optimum;
    optimum.starts = starts_;
    optimum.place = best_of(misfit);
    misfit.weigh(optimum.place);
    misfit.residuals(optimum.place, optimum.residuals, &optimum.jacobian);
    optimum.squares = optimum.residuals.squaredNorm();
    optimum.known_errors = true;
    optimum.evaluations = asked();
    optimum.ended = ended;
    for (std::size_t q = 0; q < objective_.points(); ++q) {
      const Surrogate& surrogate = misfit.surrogates()[q];
      const Surrogate::Answer answer = surrogate.at(optimum.place);
      const auto [low, high] = std::minmax_element(
          found_.begin(), found_.end(), [q](const auto& a, const auto& b) { return a.values[q] < b.values[q]; });
      optimum.reach.push_back({answer.value, std::sqrt(answer.variance), std::sqrt(surrogate.noise()),
                               misfit.scale()[static_cast<Eigen::Index>(q)], low->values[q], high->values[q]});
    }
    return optimum;
  }

  Objective& objective_;
  const OptimizerOptions& options_;
  Draw draw_;
  Places all_, places_;            // evaluated; evaluated with an answer
  std::vector<Prediction> found_;  // at places_
  std::string problem_;
  std::vector<StartResult> starts_;
};

}  // namespace

Optimum optimize_noisy(Objective& objective, const OptimizerOptions& options) {
  FURROW_ASSERT(options.evaluations >= least_evaluations(objective.parameters()), options.evaluations);
  return Noisy(objective, options).run();
}

}  // namespace furrow::calibrate
