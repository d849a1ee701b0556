#include "vehicle/analysis/tire_curve.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "vehicle/multibody/table.hpp"

namespace furrow::vehicle {

TireCurve tire_curve(const std::string& name, double radius, const std::vector<std::pair<double, double>>& points) {
  FURROW_ASSERT(radius > 0.0, radius);
  FURROW_ASSERT(!points.empty() && points.front() == std::pair(0.0, 0.0), points.size());
  const Table table(name, points, TableCurve::monotone_cubic);
  return {radius, [table](double deflection) { return deflection > 0.0 ? table.value(deflection) : 0.0; }};
}

TireCurve stiff_curve(double radius, double stiffness) {
  FURROW_ASSERT(radius > 0.0 && stiffness > 0.0, radius, stiffness);
  return {radius, [stiffness](double deflection) { return stiffness * std::max(0.0, deflection); }};
}

}  // namespace furrow::vehicle
