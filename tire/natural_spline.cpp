// Second derivatives m_k from continuity of the slope, h_k = t_{k+1} − t_k:
//   h_{k−1} m_{k−1} + 2 (h_{k−1} + h_k) m_k + h_k m_{k+1} = 6 [(y_{k+1} − y_k)/h_k − (y_k − y_{k−1})/h_{k−1}]
#include "tire/natural_spline.hpp"

#include <algorithm>
#include <functional>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

NaturalSpline::NaturalSpline(std::vector<double> t, std::vector<double> values)
    : t_(std::move(t)), y_(std::move(values)), second_(t_.size(), 0.0) {
  FURROW_ASSERT(t_.size() >= 2 && y_.size() == t_.size(), t_.size(), y_.size());
  FURROW_ASSERT(std::adjacent_find(t_.begin(), t_.end(), std::greater_equal<>()) == t_.end(), t_.size());
  const std::size_t n = t_.size();
  std::vector<double> diagonal(n, 1.0), right(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = t_[k] - t_[k - 1], after = t_[k + 1] - t_[k];
    diagonal[k] = 2.0 * (before + after);
    right[k] = 6.0 * ((y_[k + 1] - y_[k]) / after - (y_[k] - y_[k - 1]) / before);
    if (k > 1) {
      const double factor = before / diagonal[k - 1];
      diagonal[k] -= factor * before;
      right[k] -= factor * right[k - 1];
    }
  }
  for (std::size_t k = n - 2; k >= 1 && k < n; --k)
    second_[k] = (right[k] - (t_[k + 1] - t_[k]) * second_[k + 1]) / diagonal[k];
}

std::size_t NaturalSpline::span(double t) const {
  const auto above = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  return static_cast<std::size_t>(above - t_.begin()) - 1;
}

double NaturalSpline::value(double t) const {
  const std::size_t k = span(t);
  const double h = t_[k + 1] - t_[k], a = (t_[k + 1] - t) / h, b = 1.0 - a;
  return a * y_[k] + b * y_[k + 1] + ((a * a * a - a) * second_[k] + (b * b * b - b) * second_[k + 1]) * h * h / 6.0;
}

double NaturalSpline::slope(double t) const {
  const std::size_t k = span(t);
  const double h = t_[k + 1] - t_[k], a = (t_[k + 1] - t) / h, b = 1.0 - a;
  return (y_[k + 1] - y_[k]) / h + ((1.0 - 3.0 * a * a) * second_[k] + (3.0 * b * b - 1.0) * second_[k + 1]) * h / 6.0;
}

}  // namespace furrow::tire
