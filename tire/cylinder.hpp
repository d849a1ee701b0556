// The undeformed surface of tires whose section does not change across their width.
#pragma once

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// A cylinder of `facets` equal pieces about the y axis, without material and mass. A disc closes each end; the last
/// two vertices are the middles of the discs. @param rows of vertices across, from +y to −y
/// @pre facets ≥ 3, rows ≥ 2; radius, width > 0, m
TireShape cylinder(int facets, double radius, double width, int rows = 2);

}  // namespace furrow::tire
