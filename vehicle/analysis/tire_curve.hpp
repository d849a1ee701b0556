// Press curves of tires for the trim.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vehicle/analysis/trim.hpp"

namespace furrow::vehicle {

/// Curve through points (deflection, m; force, N), monotone between them and straight beyond the last.
/// @pre the first is (0, 0), both rise. @param name for errors
TireCurve tire_curve(const std::string& name, double radius, const std::vector<std::pair<double, double>>& points);

/// Curve of a tire that does not deflect, on ground of this stiffness, N/m.
TireCurve stiff_curve(double radius, double stiffness);

}  // namespace furrow::vehicle
