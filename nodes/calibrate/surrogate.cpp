#include "nodes/calibrate/surrogate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::calibrate {
namespace {

constexpr double kLengths[] = {0.3, 0.5, 0.8, 1.3, 2.0, 3.5};
constexpr double kSignals[] = {0.0, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0, 10.0};  // of the values' variance
constexpr double kBeyond[] = {1.0, 1.5, 2.5, 4.0};                                // of the noise that the model reports
constexpr double kUnknown[] = {1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0};
constexpr double kLeast = 1e-8;     // of the values' variance: rounding
constexpr double kOwn = 1.0 / 3.0;  // weight of an evaluation's own error in its variance

/// Median of the known squares; 0: none is known.
double median_square(const std::vector<double>& errors) {
  std::vector<double> squares;
  for (const double error : errors)
    if (std::isfinite(error) && error > 0.0) squares.push_back(error * error);
  if (squares.empty()) return 0.0;
  std::sort(squares.begin(), squares.end());
  const std::size_t half = squares.size() / 2;
  return squares.size() % 2 ? squares[half] : 0.5 * (squares[half - 1] + squares[half]);
}

}  // namespace

Surrogate::Surrogate(const Eigen::MatrixXd& places, const Eigen::VectorXd& values, const std::vector<double>& errors)
    : places_(places) {
  const Eigen::Index n = places.cols(), p = places.rows();
  FURROW_ASSERT(n >= 2 && values.size() == n, n, values.size());
  FURROW_ASSERT(errors.empty() || static_cast<Eigen::Index>(errors.size()) == n, n, errors.size());
  mean_ = values.mean();
  spread_ = std::sqrt((values.array() - mean_).square().mean());
  if (!(spread_ > 0.0)) spread_ = 1.0;
  values_ = (values.array() - mean_) / spread_;
  const bool sloped = n >= p + 2;  // fewer evaluations do not determine a slope
  trend_ = Eigen::MatrixXd::Ones(n, sloped ? p + 1 : 1);
  if (sloped) trend_.rightCols(p) = places.transpose();

  const double noise = median_square(errors);
  const bool told = noise > 0.0;
  weights_ = Eigen::VectorXd::Ones(n);
  for (std::size_t i = 0; told && i < errors.size(); ++i)
    if (std::isfinite(errors[i]))
      weights_[static_cast<Eigen::Index>(i)] = 1.0 - kOwn + kOwn * errors[i] * errors[i] / noise;
  std::vector<double> noises;
  for (const double part : told ? std::span<const double>(kBeyond) : std::span<const double>(kUnknown))
    noises.push_back(std::max(told ? part * noise / (spread_ * spread_) : part, kLeast));
  state_.likelihood = -std::numeric_limits<double>::infinity();
  bool found = false;
  for (const double part : noises)
    for (const double signal : kSignals)
      for (const double length : kLengths) {
        State state;
        state.signal = signal, state.length = length, state.noise = part;
        if (solve(state) && (!found || state.likelihood > state_.likelihood)) state_ = std::move(state), found = true;
        if (signal == 0.0) break;  // then the length has no effect
      }
  FURROW_ASSERT(found, n, p);
  noise_ = state_.noise * spread_ * spread_;
}

// −½ (ln|C| + ln|HᵀC⁻¹H| + (y − Hβ)ᵀC⁻¹(y − Hβ))
bool Surrogate::solve(State& s) const {
  const Eigen::Index n = places_.cols();
  Eigen::MatrixXd C(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      C(i, j) = C(j, i) =
          s.signal * std::exp(-0.5 * (places_.col(i) - places_.col(j)).squaredNorm() / (s.length * s.length)) +
          (i == j ? s.noise * weights_[i] : 0.0);
  s.covariance.compute(C);
  if (s.covariance.info() != Eigen::Success) return false;
  s.weighted = s.covariance.solve(trend_);
  s.trend.compute(trend_.transpose() * s.weighted);
  if (s.trend.info() != Eigen::Success) return false;
  s.beta = s.trend.solve(s.weighted.transpose() * values_);
  const Eigen::VectorXd off = values_ - trend_ * s.beta;
  s.rest = s.covariance.solve(off);
  const double logs =
      s.covariance.matrixLLT().diagonal().array().log().sum() + s.trend.matrixLLT().diagonal().array().log().sum();
  s.likelihood = -logs - 0.5 * off.dot(s.rest);
  return std::isfinite(s.likelihood);
}

Eigen::VectorXd Surrogate::trend_at(const Eigen::VectorXd& place) const {
  Eigen::VectorXd h = Eigen::VectorXd::Ones(trend_.cols());
  if (h.size() > 1) h.tail(place.size()) = place;
  return h;
}

Surrogate::Answer Surrogate::at(const Eigen::VectorXd& place) const {
  FURROW_ASSERT(place.size() == places_.rows(), place.size(), places_.rows());
  const Eigen::VectorXd h = trend_at(place);
  const Eigen::MatrixXd away = places_.colwise() - place;  // ∂k/∂s = k (sᵢ − s)/ℓ²
  const double square = state_.length * state_.length;
  const Eigen::VectorXd k = state_.signal * (-0.5 * away.colwise().squaredNorm() / square).array().exp();
  Answer answer;
  answer.value = mean_ + spread_ * (h.dot(state_.beta) + k.dot(state_.rest));
  const Eigen::VectorXd u = h - state_.weighted.transpose() * k;
  const double variance = state_.signal - k.dot(state_.covariance.solve(k)) + u.dot(state_.trend.solve(u));
  answer.variance = spread_ * spread_ * std::max(variance, 0.0);
  answer.gradient = away * (k.array() * state_.rest.array()).matrix() / square;
  if (h.size() > 1) answer.gradient += state_.beta.tail(place.size());
  answer.gradient *= spread_;
  return answer;
}

}  // namespace furrow::calibrate
