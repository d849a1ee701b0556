// The undeformed surface of tires that are alike across their width.
#pragma once

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// A cylinder of `facets` equal pieces about the y axis, closed by discs with a vertex at their middle, the last two;
/// without material and mass. @param rows of vertices across, from +y to −y
/// @pre facets ≥ 3, rows ≥ 2; radius, width > 0, m
TireShape cylinder(int facets, double radius, double width, int rows = 2);

}  // namespace furrow::tire
