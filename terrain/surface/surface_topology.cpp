#include "terrain/surface/surface_topology.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

struct HalfEdge {
  int low, high;  // its vertices
  int triangle, edge;
  std::array<int, 4> key() const { return {low, high, triangle, edge}; }
};

}  // namespace

SurfaceTopology::SurfaceTopology(const SurfaceMesh& mesh) {
  FURROW_ASSERT(mesh.vertex_count >= 0, mesh.vertex_count);
  const int count = static_cast<int>(mesh.triangles.size());
  std::vector<HalfEdge> half;
  half.reserve(3 * mesh.triangles.size());
  first.assign(mesh.vertex_count + 1, 0);
  for (int t = 0; t < count; ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      half.push_back({std::min(a, b), std::max(a, b), t, k});
      ++first[a + 1];
    }
  // After sorting by vertices, the half-edges of one edge are next to each other.
  std::sort(half.begin(), half.end(), [](const HalfEdge& p, const HalfEdge& q) { return p.key() < q.key(); });
  neighbour.assign(count, {-1, -1, -1});
  boundary_vertex.assign(mesh.vertex_count, 0);
  for (std::size_t i = 0; i < half.size();) {
    std::size_t end = i + 1;
    while (end < half.size() && half[end].low == half[i].low && half[end].high == half[i].high) ++end;
    if (end - i == 2) {
      neighbour[half[i].triangle][half[i].edge] = half[i + 1].triangle;
      neighbour[half[i + 1].triangle][half[i + 1].edge] = half[i].triangle;
    } else {
      boundary_vertex[half[i].low] = boundary_vertex[half[i].high] = 1;
    }
    i = end;
  }
  for (int v = 0; v < mesh.vertex_count; ++v) first[v + 1] += first[v];
  incident.resize(3 * mesh.triangles.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int t = 0; t < count; ++t)
    for (int v : mesh.triangles[t]) incident[next[v]++] = t;
}

}  // namespace furrow::terrain
