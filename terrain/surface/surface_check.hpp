// Requirements of every terrain on a contact surface that is attached to it.
#pragma once

#include "protocol/core/surface.hpp"

namespace furrow::terrain {

/// @param index  of the surface, for the message
/// @throws Error(bad_input) when there is not one position for each vertex, a triangle refers to a vertex that does not
/// exist, or a position is not finite
void check_surface(const SurfaceMesh& mesh, const SurfaceState& start, int index);

}  // namespace furrow::terrain
