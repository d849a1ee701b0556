// Displacements, forces and the tangent of a flexible ring, segment by segment.
#pragma once

#include <array>
#include <vector>

namespace furrow::tire {

/// Displacements, or forces on them, of all segments.
struct RingField {
  std::vector<double> u, v;  // radial, outwards; tangential, towards growing θ: m or N
};

/// Symmetric tangent without air: the 2 × 2 blocks of segments j and j + d, d = 0, 1, 2, indices modulo N.
struct RingTangent {
  std::array<std::vector<double>, 3> uu, uv, vu, vv;  // uv[d][j]: of u_j with v_{j+d}; N/m
  double gas = 0.0;                                   // of every u with every u, N/m
};

/// Adds factor × a symmetric matrix in (u, v) of three neighbouring segments, row by row, from segment `first` on.
void add_local(RingTangent& tangent, int first, const std::array<double, 36>& matrix, double factor);

/// Tangent × change on segment j, N. @param sum of all change.u
std::array<double, 2> tangent_row(const RingTangent& tangent, const RingField& change, double sum, int j);

}  // namespace furrow::tire
