// The undeformed surface of tires that are alike across their width.
#pragma once

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// A cylinder of `facets` equal pieces about the y axis, closed by discs with a vertex at their middle; without material
/// and mass. @pre facets ≥ 3; radius, width > 0, m
TireShape cylinder(int facets, double radius, double width);

}  // namespace furrow::tire
