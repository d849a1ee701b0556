// Neighbours in a contact surface, from which pseudo-normals of edges and vertices are computed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::terrain {

struct SurfaceTopology {
  std::vector<std::array<int, 3>> neighbour;  // triangle across edge k (vertex k to k+1); −1 if there is none
  std::vector<std::uint8_t> boundary_vertex;  // 1: on an edge that does not border exactly two triangles
  std::vector<int> first, incident;           // vertex → its triangles, as slices of `incident`

  SurfaceTopology() = default;
  explicit SurfaceTopology(const SurfaceMesh& mesh);

  /// Triangles around a vertex, ascending.
  std::span<const int> around(int vertex) const {
    FURROW_ASSERT(in_range(vertex + 1, first.size()), vertex, first.size());
    return {incident.data() + first[vertex], static_cast<std::size_t>(first[vertex + 1] - first[vertex])};
  }
};

}  // namespace furrow::terrain
