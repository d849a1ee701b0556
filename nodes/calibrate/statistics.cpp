#include "nodes/calibrate/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/SVD>

#include "protocol/core/assert.hpp"
#include "protocol/core/student_t.hpp"

namespace furrow::calibrate {
namespace {

constexpr double kAtBound = 1e-6;     // of the scale
constexpr double kWide = 0.5;         // of the scale
constexpr double kDegenerate = 1e-6;  // of the largest singular value: below it, differences are too inaccurate
constexpr double kNormal = 1.959964;  // 97.5 % point of the normal distribution
constexpr double kNoValue = 1.0;      // of the scale: an interval as wide gives no value
constexpr double kNamed = 0.02;       // of a direction: smaller parts are not listed

}  // namespace

Confidence confidence(std::span<const Parameter> parameters, const Eigen::VectorXd& place,
                      const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian, bool known_errors) {
  const auto all = static_cast<Eigen::Index>(parameters.size());
  FURROW_ASSERT(jacobian.cols() == all && jacobian.rows() == residuals.size(), jacobian.cols(), all);
  Confidence c;
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < all; ++k) {
    const Bound at = place[k] <= kAtBound ? Bound::lower : place[k] >= 1.0 - kAtBound ? Bound::upper : Bound::none;
    c.estimates.push_back({parameters[static_cast<std::size_t>(k)].off_scale(place[k]), at, {}, {}, {}});
    if (at == Bound::none) free.push_back(k);
  }
  c.freedom = static_cast<int>(residuals.size()) - static_cast<int>(free.size());
  FURROW_ASSERT(c.freedom > 0 || known_errors, c.freedom);
  c.deviation = known_errors ? 1.0 : residuals.norm() / std::sqrt(c.freedom);
  const double t = known_errors ? kNormal : student_t(c.freedom);
  const auto half_width = [&](const Eigen::VectorXd& w, Eigen::Index i) {
    return w[i] <= kDegenerate * w[0] ? std::numeric_limits<double>::infinity() : t * c.deviation / w[i];
  };
  // A valley may end at bounds, so that parameters there count here.
  const Eigen::JacobiSVD<Eigen::MatrixXd> whole(jacobian, Eigen::ComputeThinV);
  for (Eigen::Index i = 0; i < whole.singularValues().size(); ++i) {
    const double w = whole.singularValues()[i];
    // A fit without residuals has no σ̂: the singular values are then those of J.
    c.singular_values.push_back(c.deviation > 0.0 ? w / c.deviation : w);
    const double half = half_width(whole.singularValues(), i);
    if (half < kWide) continue;
    const Eigen::VectorXd v = whole.matrixV().col(i);
    Eigen::Index lead = 0;
    v.cwiseAbs().maxCoeff(&lead);
    const Eigen::VectorXd direction = std::copysign(1.0, v[lead]) * v;
    c.undetermined.push_back({{direction.begin(), direction.end()}, half});
  }
  if (free.empty()) return c;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian(Eigen::all, free), Eigen::ComputeThinV);
  const Eigen::VectorXd& w = svd.singularValues();
  Eigen::ArrayXd variance = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(free.size()));
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const Eigen::VectorXd v = svd.matrixV().col(i);
    // Parameters with no part but round-off in a degenerate direction keep their error.
    if (std::isinf(half_width(w, i)))
      variance += (v.array().abs() > kDegenerate).select(std::numeric_limits<double>::infinity(), 0.0 * v.array());
    else
      variance += c.deviation * c.deviation / (w[i] * w[i]) * v.array().square();
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double error = std::sqrt(variance[static_cast<Eigen::Index>(k)]), share = place[free[k]];
    if (!(t * error < kNoValue)) continue;
    const auto which = static_cast<std::size_t>(free[k]);
    Estimate& e = c.estimates[which];
    const Parameter& p = parameters[which];
    e.standard_error = error * p.slope(share);
    e.low = p.off_scale(share - t * error), e.high = p.off_scale(share + t * error);
  }
  return c;
}

std::string combination_text(std::span<const Parameter> parameters, std::span<const double> direction) {
  std::vector<std::size_t> order(direction.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  std::string text;
  for (const std::size_t k : order) {
    if (std::abs(direction[k]) < kNamed) break;
    const char* sign = direction[k] < 0.0 ? (text.empty() ? "−" : " − ") : (text.empty() ? "" : " + ");
    text += fmt::format("{}{:.2f} {}", sign, std::abs(direction[k]), parameters[k].name);
  }
  return text;
}

double Goodness::r_squared() const {
  return total > 0.0 ? 1.0 - off / total : std::numeric_limits<double>::quiet_NaN();
}

Goodness goodness(const Target& target, std::span<const double> model) {
  FURROW_ASSERT(model.size() == target.y.size(), model.size(), target.y.size());
  const auto points = static_cast<Eigen::Index>(model.size());
  const Eigen::Map<const Eigen::ArrayXd> y(target.y.data(), points), sigma(target.sigma.data(), points);
  const Eigen::ArrayXd weight = sigma.square().inverse(),
                       error = (Eigen::Map<const Eigen::ArrayXd>(model.data(), points) - y).abs();
  const double mean = (weight * y).sum() / weight.sum();
  return {(weight * error.square()).sum(), (weight * (y - mean).square()).sum(), error.maxCoeff(), y.abs().maxCoeff(),
          std::sqrt(error.square().mean())};
}

double joint_r_squared(const std::vector<Target>& targets, std::span<const double> model) {
  Goodness all;
  for (const Target& target : targets) {
    const Goodness g = goodness(target, model.first(target.y.size()));
    all.off += g.off, all.total += g.total;
    model = model.subspan(target.y.size());
  }
  return all.r_squared();
}

}  // namespace furrow::calibrate
