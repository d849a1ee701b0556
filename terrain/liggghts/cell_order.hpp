// Order of the grains in memory: by cells of the bin, so that neighbours in space are neighbours in memory. Otherwise a
// bed has them in the order in which they were dropped, and messages in the order of arrival.
#pragma once

#include <cmath>
#include <tuple>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::liggghts {

/// Sort key of a grain: its cell, z fastest, then y, then x; within a cell its number. Cells are as wide as the largest
/// grain. @param x  of its centre, m  @param largest  radius > 0, m
inline auto place_in_order(const double* x, int number, double largest) {
  FURROW_ASSERT(largest > 0.0, largest);
  const double per_cell = 0.5 / largest;
  return std::tuple(std::floor(x[0] * per_cell), std::floor(x[1] * per_cell), std::floor(x[2] * per_cell), number);
}

}  // namespace furrow::terrain::liggghts
