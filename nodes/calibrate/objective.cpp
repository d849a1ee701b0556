#include "nodes/calibrate/objective.hpp"

#include <utility>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"

namespace furrow::calibrate {
namespace {

/// Held-out targets may change while evaluations of the fitted ones stay: theirs are kept apart by what they depend on.
std::string state_of(const std::vector<Target>& held_out) {
  Hash hash;
  for (const Target& target : held_out) {
    hash.add(target.state), hash.add("\n");
    hash.add(std::span<const double>(target.x));
  }
  return std::string(kSetNames.held_out) + " " + hash.hex();
}

}  // namespace

Objective::Objective(const Calibration& calibration, EvaluationTable& table, ProgressCall progress)
    : calibration_(calibration),
      table_(table),
      progress_(std::move(progress)),
      held_out_state_(state_of(calibration.model->targets(TargetSet::held_out))) {
  for (const Target& target : calibration.model->targets(TargetSet::fitted)) {
    FURROW_ASSERT(target.sigma.size() == target.y.size(), target.sigma.size(), target.y.size());
    data_.insert(data_.end(), target.y.begin(), target.y.end());
    sigma_.insert(sigma_.end(), target.sigma.begin(), target.sigma.end());
  }
}

std::vector<double> Objective::values(std::span<const double> shares) const {
  FURROW_ASSERT(shares.size() == parameters(), shares.size(), parameters());
  std::vector<double> values;
  for (std::size_t k = 0; k < shares.size(); ++k) values.push_back(calibration_.parameters[k].off_scale(shares[k]));
  return values;
}

std::vector<double> Objective::start() const {
  std::vector<double> shares;
  for (const Parameter& p : calibration_.parameters) shares.push_back(p.on_scale(p.start));
  return shares;
}

const Prediction& Objective::predict(std::span<const double> shares, TargetSet set) {
  const std::vector<double> at = values(shares);
  const std::string state = set == TargetSet::fitted ? std::string(kSetNames.fitted) : held_out_state_;
  ++asked_;
  if (const Prediction* known = table_.find(state, at)) return *known;
  Prediction found = calibration_.model->predict(at, set, progress_);
  const std::size_t points = points_of(calibration_.model->targets(set));
  FURROW_ASSERT(!found.problem.empty() || found.values.size() == points, found.values.size(), points);
  ++computed_;
  return table_.add(state, at, std::move(found));
}

std::optional<Eigen::VectorXd> Objective::residuals(std::span<const double> shares) {
  const Prediction& found = predict(shares);
  if (!found.problem.empty()) return std::nullopt;
  Eigen::VectorXd r(points());
  for (std::size_t k = 0; k < points(); ++k) r[k] = (found.values[k] - data_[k]) / sigma_[k];
  if (!r.allFinite()) return std::nullopt;
  return r;
}

// Central: (r₊ − r₋)/2h. One-sided, of the same order: ±(−3r₀ + 4r₁ − r₂)/2h.
std::optional<Eigen::MatrixXd> Objective::jacobian(std::span<const double> shares, const Eigen::VectorXd& at) {
  Eigen::MatrixXd J(points(), parameters());
  std::vector<double> moved(shares.begin(), shares.end());
  for (std::size_t k = 0; k < moved.size(); ++k) {
    const double here = shares[k], h = kDifference;
    const auto to = [&](double share) -> std::optional<Eigen::VectorXd> {
      if (share < 0.0 || share > 1.0) return std::nullopt;
      moved[k] = share;
      return residuals(moved);
    };
    const auto up = to(here + h), down = to(here - h);
    if (up && down) {
      J.col(k) = (*up - *down) / (2.0 * h);
    } else if (up || down) {
      const double side = up ? h : -h;
      const auto far = to(here + 2.0 * side);
      if (!far) return std::nullopt;
      J.col(k) = (-3.0 * at + 4.0 * (up ? *up : *down) - *far) / (2.0 * side);
    } else {
      return std::nullopt;
    }
    moved[k] = here;
  }
  return J;
}

}  // namespace furrow::calibrate
