// Checks that a contact surface is not turned inside out: such a surface pushes nothing back. Seen from outside,
// triangles run counter-clockwise. With vertices x about the wheel's centre c the signed volume of the cones over its
// triangles,
//   V = 1/6 Σ (x₁ − c)·((x₂ − c) × (x₃ − c)),                                                                (1)
// is positive for a closed surface and for one that is open towards the rim or at its sides.
#pragma once

#include <span>
#include <string>

#include "protocol/core/surface.hpp"

namespace furrow::tire {

/// @param the tire's file, for the message
/// @throws Error(bad_input) when a triangle names a vertex that does not exist, two neighbours run against each other,
/// or (1) is not positive
void require_outward(const SurfaceMesh& mesh, std::span<const Vec3> position, const Vec3& centre,
                     const std::string& who);

}  // namespace furrow::tire
