// Press curves of tires, as the trim needs them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vehicle/analysis/trim.hpp"

namespace furrow::vehicle {

/// Through points (deflection, m; force, N), monotone between them and straight beyond the last.
/// @pre the first is (0, 0), both rise. @param name for errors
TireCurve tire_curve(const std::string& name, double radius, const std::vector<std::pair<double, double>>& points);

/// A tire that does not deflect stands on ground of this stiffness, N/m.
TireCurve stiff_curve(double radius, double stiffness);

}  // namespace furrow::vehicle
