#include "terrain/surface/surface_check.hpp"

#include <cmath>

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

void check_saved_material(const ContactMaterial& m, int index) {
  const bool finite = std::isfinite(m.young_modulus) && std::isfinite(m.friction) &&
                      std::isfinite(m.normal_stiffness) && std::isfinite(m.normal_damping) &&
                      std::isfinite(m.cohesion) && std::isfinite(m.area_density);
  const bool possible = m.young_modulus > 0.0 && m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5 &&
                        m.friction >= 0.0 && m.restitution >= 0.0 && m.restitution <= 1.0 &&
                        m.normal_stiffness >= 0.0 && m.normal_damping >= 0.0 && m.cohesion >= 0.0 &&
                        m.area_density >= 0.0;
  if (!finite || !possible)
    throw Error(ExitCode::io,
                fmt::format("saved state of surface {} holds a material that cannot be: it is damaged", index));
}

}  // namespace furrow::terrain
