// Natural cubic spline through given points: twice continuously differentiable, second derivative zero at
// both ends.
#pragma once

#include <vector>

namespace furrow::tire {

class NaturalSpline {
 public:
  /// @pre t strictly increasing, at least two points
  NaturalSpline(std::vector<double> t, std::vector<double> values);
  double value(double t) const;
  double slope(double t) const;

 private:
  std::size_t span(double t) const;
  std::vector<double> t_, y_, second_;
};

}  // namespace furrow::tire
