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
constexpr double kDegenerate = 1e-6;  // of the largest singular value: differences say no more
constexpr double kNormal = 1.959964;  // 97.5 % point of the normal distribution
constexpr double kNoValue = 1.0;      // of the scale: an interval as wide says nothing
constexpr double kNamed = 0.02;       // of a direction

struct Sums {
  double off = 0.0, total = 0.0;
};

Sums sums_of(const Target& target, std::span<const double> model) {
  FURROW_ASSERT(model.size() == target.y.size(), model.size(), target.y.size());
  double weight = 0.0, mean = 0.0;
  for (std::size_t k = 0; k < target.y.size(); ++k) {
    const double w = 1.0 / (target.sigma[k] * target.sigma[k]);
    weight += w, mean += w * target.y[k];
  }
  mean /= weight;
  Sums sums;
  for (std::size_t k = 0; k < target.y.size(); ++k) {
    const double w = 1.0 / (target.sigma[k] * target.sigma[k]);
    sums.off += w * (model[k] - target.y[k]) * (model[k] - target.y[k]);
    sums.total += w * (target.y[k] - mean) * (target.y[k] - mean);
  }
  return sums;
}

double r_squared(const Sums& sums) {
  return sums.total > 0.0 ? 1.0 - sums.off / sums.total : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Confidence confidence(std::span<const Parameter> parameters, std::span<const double> place,
                      const Eigen::VectorXd& residuals, const Eigen::MatrixXd& jacobian, bool known_errors) {
  const auto all = static_cast<Eigen::Index>(parameters.size());
  FURROW_ASSERT(jacobian.cols() == all && jacobian.rows() == residuals.size(), jacobian.cols(), all);
  Confidence c;
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    Estimate e{parameters[k].off_scale(place[k]), Bound::none, {}, {}, {}};
    if (place[k] <= kAtBound)
      e.at = Bound::lower;
    else if (place[k] >= 1.0 - kAtBound)
      e.at = Bound::upper;
    else
      free.push_back(static_cast<Eigen::Index>(k));
    c.estimates.push_back(e);
  }
  c.freedom = static_cast<int>(residuals.size()) - static_cast<int>(free.size());
  FURROW_ASSERT(c.freedom > 0 || known_errors, c.freedom);
  c.deviation = known_errors ? 1.0 : residuals.norm() / std::sqrt(c.freedom);
  if (free.empty()) return c;
  Eigen::MatrixXd J(residuals.size(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) J.col(static_cast<Eigen::Index>(k)) = jacobian.col(free[k]);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinV);
  const Eigen::VectorXd& w = svd.singularValues();
  const double t = known_errors ? kNormal : student_t(c.freedom);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(J.cols());
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    // A fit without residuals has no σ̂: singular values are then those of J.
    c.singular_values.push_back(c.deviation > 0.0 ? w[i] / c.deviation : w[i]);
    const bool degenerate = w[i] <= kDegenerate * w[0];
    const double half = degenerate ? std::numeric_limits<double>::infinity() : t * c.deviation / w[i];
    if (half >= kWide) {
      Undetermined u{std::vector<double>(parameters.size(), 0.0), half};
      Eigen::Index lead = 0;
      svd.matrixV().col(i).cwiseAbs().maxCoeff(&lead);
      const double sign = svd.matrixV()(lead, i) < 0.0 ? -1.0 : 1.0;
      for (std::size_t k = 0; k < free.size(); ++k)
        u.direction[static_cast<std::size_t>(free[k])] = sign * svd.matrixV()(static_cast<Eigen::Index>(k), i);
      c.undetermined.push_back(u);
    }
    const Eigen::ArrayXd v = svd.matrixV().col(i).array();
    if (degenerate) {
      // Parameters that have no part in the direction but round-off keep their error.
      variance += (v.abs() > kDegenerate).select(std::numeric_limits<double>::infinity(), 0.0 * v).matrix();
    } else {
      variance += (c.deviation * c.deviation / (w[i] * w[i]) * v.square()).matrix();
    }
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto which = static_cast<std::size_t>(free[k]);
    const double error = std::sqrt(variance[static_cast<Eigen::Index>(k)]);
    if (!(t * error < kNoValue)) continue;
    Estimate& e = c.estimates[which];
    const Parameter& p = parameters[which];
    e.standard_error = error * p.slope(place[which]);
    e.low = p.off_scale(place[which] - t * error), e.high = p.off_scale(place[which] + t * error);
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

Goodness goodness(const Target& target, std::span<const double> model) {
  Goodness g;
  g.r_squared = r_squared(sums_of(target, model));
  double squares = 0.0;
  for (std::size_t k = 0; k < target.y.size(); ++k) {
    const double error = std::abs(model[k] - target.y[k]);
    g.largest_error = std::max(g.largest_error, error);
    g.peak = std::max(g.peak, std::abs(target.y[k]));
    squares += error * error;
  }
  g.root_mean_square = std::sqrt(squares / static_cast<double>(target.y.size()));
  return g;
}

double joint_r_squared(const std::vector<Target>& targets, std::span<const double> model) {
  Sums all;
  for (const Target& target : targets) {
    const Sums sums = sums_of(target, model.first(target.y.size()));
    all.off += sums.off, all.total += sums.total;
    model = model.subspan(target.y.size());
  }
  return r_squared(all);
}

}  // namespace furrow::calibrate
