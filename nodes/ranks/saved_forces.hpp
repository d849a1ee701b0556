// Reads nodal forces from a saved state.
#pragma once

#include <string>

#include <fmt/format.h>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::ranks {

/// @param vertices of the surface on which the forces act
/// @throws Error(io) unless every force has its vertex on that surface, and its tangent if there are tangents
inline void restore_forces(const Archive& archive, const std::string& name, std::size_t vertices, NodalForces& forces) {
  restore_fields(archive, name, forces);
  const std::size_t count = forces.vertex.size();
  if (forces.force.size() != count || (!forces.tangent.empty() && forces.tangent.size() != count))
    throw Error(ExitCode::io, fmt::format("saved state '{}' has {} forces and {} tangents, expected {} of each", name,
                                          forces.force.size(), forces.tangent.size(), count));
  for (const int vertex : forces.vertex)
    if (!in_range(vertex, vertices))
      throw Error(ExitCode::io, fmt::format("saved state '{}' has a force on vertex {}, expected 0 to {}", name, vertex,
                                            vertices - 1));
}

}  // namespace furrow::ranks
