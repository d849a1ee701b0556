#include "vehicle/multibody/table.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::vehicle {
namespace {

std::string text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Slopes at the points for a monotone curve: the harmonic mean of the chords' slopes, weighted by the lengths of the
/// intervals [Fritsch & Butland 1984, doi:10.1137/0905021], 0 if they differ in sign, the chord's own slope at the
/// ends.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> slopes(n);
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  slopes.front() = chord(0);
  slopes.back() = chord(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = chord(i - 1), after = chord(i);
    if (!(before * after > 0.0)) continue;
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
    const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    slopes[i] = (w0 + w1) / (w0 / before + w1 / after);
  }
  return slopes;
}

}  // namespace

Table::Table(const std::string& name, std::vector<std::pair<double, double>> points, TableCurve curve, TableEnd end)
    : curve_(curve), end_(end) {
  if (points.size() < 2) throw physics_error("table '" + name + "': it has less than two points");
  for (const auto& [x, y] : points) {
    if (!std::isfinite(x) || !std::isfinite(y)) throw physics_error("table '" + name + "': a value is not finite");
    if (!x_.empty() && !(x > x_.back()))
      throw physics_error("table '" + name + "': " + text(x) + " follows " + text(x_.back()) +
                          ", expected rising values");
    x_.push_back(x);
    y_.push_back(y);
  }
  slope_ = monotone_slopes(x_, y_);
  area_.assign(1, 0.0);
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double h = x_[i + 1] - x_[i];
    double area = 0.5 * h * (y_[i] + y_[i + 1]);
    if (curve_ == TableCurve::monotone_cubic) area += h * h / 12.0 * (slope_[i] - slope_[i + 1]);
    area_.push_back(area_.back() + area);
  }
  area_at_zero_ = integral_from_first(0.0);
}

Table Table::odd(const std::string& name, std::vector<std::pair<double, double>> points, TableCurve curve,
                 TableEnd end) {
  std::vector<std::pair<double, double>> all;
  for (auto point = points.rbegin(); point != points.rend(); ++point)
    if (point->first != 0.0) all.emplace_back(-point->first, -point->second);
  if (!points.empty() && (points.front().first < 0.0 || (points.front().first == 0.0 && points.front().second != 0.0)))
    throw physics_error("table '" + name + "': it begins at (" + text(points.front().first) + ", " +
                        text(points.front().second) + "), expected a positive value or (0, 0)");
  all.emplace_back(0.0, 0.0);
  for (const auto& point : points)
    if (point.first != 0.0) all.push_back(point);
  return Table(name, std::move(all), curve, end);
}

// The last point at or before x, among those that begin an interval.
std::size_t Table::interval(double x) const {
  const auto after = std::upper_bound(x_.begin(), x_.end(), x);
  const std::ptrdiff_t index = after - x_.begin() - 1;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, static_cast<std::ptrdiff_t>(x_.size()) - 2));
}

// Between points with t = (x − x_i)/h: y = (1 + 2t)(1 − t)² y₀ + t(1 − t)² h s₀ + t²(3 − 2t) y₁ + t²(t − 1) h s₁
double Table::value(double x) const {
  if (x < x_.front()) return y_.front() + (end_ == TableEnd::straight ? slope_.front() * (x - x_.front()) : 0.0);
  if (x > x_.back()) return y_.back() + (end_ == TableEnd::straight ? slope_.back() * (x - x_.back()) : 0.0);
  const std::size_t i = interval(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, u = 1.0 - t;
  if (curve_ == TableCurve::linear) return u * y_[i] + t * y_[i + 1];
  return u * u * ((1.0 + 2.0 * t) * y_[i] + t * h * slope_[i]) +
         t * t * ((3.0 - 2.0 * t) * y_[i + 1] - u * h * slope_[i + 1]);
}

double Table::slope(double x) const {
  if (x < x_.front()) return end_ == TableEnd::straight ? slope_.front() : 0.0;
  if (x > x_.back()) return end_ == TableEnd::straight ? slope_.back() : 0.0;
  const std::size_t i = interval(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, chord = (y_[i + 1] - y_[i]) / h;
  if (curve_ == TableCurve::linear) return chord;
  return 6.0 * t * (1.0 - t) * chord + (1.0 - t) * (1.0 - 3.0 * t) * slope_[i] + t * (3.0 * t - 2.0) * slope_[i + 1];
}

double Table::integral(double x) const { return integral_from_first(x) - area_at_zero_; }

double Table::integral_from_first(double x) const {
  if (x < x_.front() || x > x_.back()) {
    const bool low = x < x_.front();
    const double d = x - (low ? x_.front() : x_.back());
    return (low ? 0.0 : area_.back()) + 0.5 * d * ((low ? y_.front() : y_.back()) + value(x));
  }
  const std::size_t i = interval(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  if (curve_ == TableCurve::linear) return area_[i] + 0.5 * t * h * (y_[i] + value(x));
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
  return area_[i] +
         h * (y_[i] * (t - t3 + 0.5 * t4) + y_[i + 1] * (t3 - 0.5 * t4) +
              h * slope_[i] * (0.5 * t2 - 2.0 / 3.0 * t3 + 0.25 * t4) + h * slope_[i + 1] * (0.25 * t4 - t3 / 3.0));
}

}  // namespace furrow::vehicle
