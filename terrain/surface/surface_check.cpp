#include "terrain/surface/surface_check.hpp"

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::terrain {

void check_surface(const SurfaceMesh& mesh, const SurfaceState& start, int index) {
  const auto refuse = [&](const std::string& what) { return input_error(fmt::format("surface {}", index), "", what); };
  if (mesh.vertex_count < 0 || start.position.size() != static_cast<std::size_t>(mesh.vertex_count))
    throw refuse(fmt::format("{} positions, expected {}", start.position.size(), mesh.vertex_count));
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle)
      if (v < 0 || v >= mesh.vertex_count)
        throw refuse(fmt::format("a triangle names vertex {}, expected 0 to {}", v, mesh.vertex_count - 1));
  for (std::size_t v = 0; v < start.position.size(); ++v)
    if (!start.position[v].allFinite()) throw refuse(fmt::format("the position of vertex {} is not finite", v));
}

}  // namespace furrow::terrain
