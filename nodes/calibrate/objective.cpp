#include "nodes/calibrate/objective.hpp"

#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/hash.hpp"

namespace furrow::calibrate {
namespace {

/// Held-out targets may change without the fitted ones, so their evaluations have a state of their own.
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
  const auto joined = [&](auto member) {
    std::vector<double> all;
    for (const Target& target : calibration.model->targets(TargetSet::fitted))
      all.insert(all.end(), (target.*member).begin(), (target.*member).end());
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
  };
  data_ = joined(&Target::y), sigma_ = joined(&Target::sigma);
  FURROW_ASSERT(data_.size() == sigma_.size(), data_.size(), sigma_.size());
}

std::vector<double> Objective::values(const Eigen::VectorXd& place) const {
  std::vector<double> values;
  for (std::size_t k = 0; k < parameters(); ++k)
    values.push_back(calibration_.parameters[k].off_scale(place[static_cast<Eigen::Index>(k)]));
  return values;
}

Eigen::VectorXd Objective::start() const {
  return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(parameters()), [this](Eigen::Index k) {
    const Parameter& p = calibration_.parameters[static_cast<std::size_t>(k)];
    return p.on_scale(p.start);
  });
}

const Prediction& Objective::predict(const Eigen::VectorXd& place, TargetSet set) {
  const std::vector<double> at = values(place);
  const std::string state = set == TargetSet::fitted ? std::string(kSetNames.fitted) : held_out_state_;
  ++asked_;
  if (const Prediction* known = table_.find(state, at)) return *known;
  Prediction found = calibration_.model->predict(at, set, progress_);
  const std::size_t points = points_of(calibration_.model->targets(set));
  FURROW_ASSERT(!found.problem.empty() || found.values.size() == points, found.values.size(), points);
  ++computed_;
  return table_.add(state, at, std::move(found));
}

std::optional<Eigen::VectorXd> Objective::residuals(const Eigen::VectorXd& place) {
  const Prediction& found = predict(place);
  if (!found.problem.empty()) return std::nullopt;
  const Eigen::VectorXd r =
      (Eigen::Map<const Eigen::VectorXd>(found.values.data(), data_.size()) - data_).cwiseQuotient(sigma_);
  return r.allFinite() ? std::optional(r) : std::nullopt;
}

// Central: (r₊ − r₋)/2h. One-sided, of the same order: ±(−3r₀ + 4r₁ − r₂)/2h.
std::optional<Eigen::MatrixXd> Objective::jacobian(const Eigen::VectorXd& place, const Eigen::VectorXd& at) {
  Eigen::MatrixXd J(data_.size(), place.size());
  for (Eigen::Index k = 0; k < place.size(); ++k) {
    const auto moved = [&](double by) -> std::optional<Eigen::VectorXd> {
      Eigen::VectorXd there = place;
      there[k] += by;
      return there[k] < 0.0 || there[k] > 1.0 ? std::nullopt : residuals(there);
    };
    const double h = kDifference;
    const auto up = moved(h), down = moved(-h);
    if (up && down) {
      J.col(k) = (*up - *down) / (2.0 * h);
      continue;
    }
    const double side = up ? h : -h;
    const auto far = up || down ? moved(2.0 * side) : std::nullopt;
    if (!far) return std::nullopt;
    J.col(k) = (-3.0 * at + 4.0 * (up ? *up : *down) - *far) / (2.0 * side);
  }
  return J;
}

}  // namespace furrow::calibrate
