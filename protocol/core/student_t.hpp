// Quantiles of Student's t distribution, for confidence intervals of means of few values.
#pragma once

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow {

/// Regularized incomplete beta function I_x(a, b) by its continued fraction [Lentz; Press et al., Numerical Recipes,
/// §6.4], accurate enough for Student's distribution.
inline double incomplete_beta(double a, double b, double x) {
  FURROW_ASSERT(a > 0.0 && b > 0.0, a, b);
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
  constexpr double kTiny = 1e-300;
  double c = 1.0, d = 1.0 / std::max(1.0 - (a + b) * x / (a + 1.0), kTiny), h = d;
  for (int m = 1; m <= 300; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1.0 / (1.0 + even * d), c = 1.0 + even / c, h *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1.0 / (1.0 + odd * d), c = 1.0 + odd / c;
    h *= c * d;
    if (std::abs(c * d - 1.0) < 1e-14) break;
  }
  return front * h;
}

/// The t that Student's distribution with `freedom` degrees of freedom exceeds with probability `tail`; by default its
/// 97.5 % point. @pre freedom > 0; 0 < tail < 0.1
inline double student_t(double freedom, double tail = 0.025) {
  FURROW_ASSERT(freedom > 0.0 && tail > 0.0 && tail < 0.1, freedom, tail);
  const auto above = [freedom](double t) {
    return 0.5 * incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
  };
  double low = 1.0, high = 1e3;
  for (int k = 0; k < 100; ++k) {
    const double middle = std::sqrt(low * high);
    (above(middle) > tail ? low : high) = middle;
  }
  return low;
}

}  // namespace furrow
