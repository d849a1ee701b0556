// A function given at points. Between them it is straight or a cubic polynomial that rises and falls only where the
// points do [Fritsch & Carlson 1980]. Its slope and its integral are exact, so that a force from a table has an energy.
//
// F. N. Fritsch, R. E. Carlson, Monotone piecewise cubic interpolation, SIAM J. Numer. Anal. 17 (1980) 238–246,
// doi:10.1137/0717021.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace furrow::vehicle {

enum class TableCurve { linear, monotone_cubic };
/// Beyond the first and last point: the point's value, or the straight line with the point's slope.
enum class TableEnd { constant, straight };

class Table {
 public:
  /// `name` is used in errors. @throws Error(physics) when there are fewer than two points, x does not rise or a value
  /// is not finite
  Table(const std::string& name, std::vector<std::pair<double, double>> points, TableCurve curve = TableCurve::linear,
        TableEnd end = TableEnd::straight);
  /// The points and their mirror images, f(−x) = −f(x). @pre as above, and the first x > 0 or the first point (0, 0)
  static Table odd(const std::string& name, std::vector<std::pair<double, double>> points,
                   TableCurve curve = TableCurve::linear, TableEnd end = TableEnd::straight);

  double value(double x) const;
  double slope(double x) const;
  double integral(double x) const;  // from 0 to x
  double first() const { return x_.front(); }

 private:
  std::size_t interval(double x) const;
  double integral_from_first(double x) const;

  TableCurve curve_;
  TableEnd end_;
  std::vector<double> x_, y_, slope_;  // slopes at the points: of the cubic, and of the lines beyond the ends
  std::vector<double> area_;           // integral from the first point to each
  double area_at_zero_ = 0.0;
};

}  // namespace furrow::vehicle
