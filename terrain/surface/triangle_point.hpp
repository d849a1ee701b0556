// The point of a triangle that is closest to a given point. Like facets.hpp, for the processor and for a GPU.
#pragma once

#include <cstdint>

#include "protocol/core/triple.hpp"

namespace furrow::terrain {

using Vector = simd::Triple<double>;

/// The feature of triangle (a, b, c) that is closest. Edge k runs from vertex k to vertex k+1.
enum class TriangleRegion : std::int32_t { face, edge_0, edge_1, edge_2, vertex_0, vertex_1, vertex_2 };

struct TrianglePoint {
  Vector point;      // m
  double weight[3];  // barycentric, each ≥ 0, sum 1
  TriangleRegion region;

  /// Of an edge or a vertex, its number.
  FURROW_HD int edge() const { return static_cast<int>(region) - static_cast<int>(TriangleRegion::edge_0); }
  FURROW_HD int vertex() const { return static_cast<int>(region) - static_cast<int>(TriangleRegion::vertex_0); }
};

/// @pre 0 ≤ edge < 3
FURROW_HD inline TrianglePoint on_edge(const Vector& from, const Vector& to, double share, int edge) {
  TrianglePoint at{from + share * (to - from), {0.0, 0.0, 0.0}, TriangleRegion::edge_0};
  at.weight[edge] = 1.0 - share;
  at.weight[(edge + 1) % 3] = share;
  at.region = static_cast<TriangleRegion>(static_cast<int>(TriangleRegion::edge_0) + edge);
  return at;
}
/// @pre 0 ≤ index < 3
FURROW_HD inline TrianglePoint on_vertex(const Vector& vertex, int index) {
  TrianglePoint at{vertex, {0.0, 0.0, 0.0}, TriangleRegion::vertex_0};
  at.weight[index] = 1.0;
  at.region = static_cast<TriangleRegion>(static_cast<int>(TriangleRegion::vertex_0) + index);
  return at;
}

/// Point of triangle (a, b, c) closest to p, by the Voronoi regions of its features
/// [Ericson, Real-Time Collision Detection, 2005, §5.1.5]. @pre the triangle has an area
FURROW_HD inline TrianglePoint closest_point(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return on_vertex(a, 0);

  const Vector bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return on_vertex(b, 1);

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return on_edge(a, b, d1 / (d1 - d3), 0);

  const Vector cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return on_vertex(c, 2);

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return on_edge(c, a, 1.0 - d2 / (d2 - d6), 2);

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return on_edge(b, c, (d4 - d3) / (d4 - d3 + d5 - d6), 1);

  const double sum = va + vb + vc;
  TrianglePoint at{a, {0.0, vb / sum, vc / sum}, TriangleRegion::face};
  at.weight[0] = 1.0 - at.weight[1] - at.weight[2];
  at.point = a + at.weight[1] * ab + at.weight[2] * ac;
  return at;
}

}  // namespace furrow::terrain
