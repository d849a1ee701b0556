// Contact of one triangle with the plane z = 0 as an elastic layer (Winkler foundation): at depth g = −z the ground
// pushes up with the pressure
//
//   p = max(0, κ g + d ġ),  never tensile,
//
// over the triangle's area projected onto the plane. The part of the triangle below the plane is integrated exactly
// for a linear pressure and exactly for its moment: it is cut at z = 0 into one or two triangles, each with the
// three-point rule of degree 2 [Strang & Fix, An Analysis of the Finite Element Method, 1973, p. 184]. Forces thus
// vary smoothly as facets roll in, and do not depend on how a flat face is cut.
#pragma once

#include <array>
#include <vector>

#include "protocol/core/vec.hpp"
#include "terrain/rigid/ground_profile.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain {

struct GroundLaw {
  double stiffness = 0.0;        // κ, N/m³
  double damping = 0.0;          // d, N s/m³, in pressure and in shear
  double shear_stiffness = 0.0;  // κ_t, N/m³
  double friction = 0.0;         // μ, -
  double velocity_scale = 0.0;   // c, s/m
};

/// A part of a triangle below the plane: one integration point.
struct GroundPoint {
  std::array<double, 3> weight{};  // barycentric
  double area = 0.0;               // projected, m²; on a profile: of the triangle itself
  double depth = 0.0;              // g ≥ 0, m
  bool level = true;               // of a profile: the ground is level around it
  double cosine = 1.0;             // of a height map: of the angle between its skin and the level
};

/// Most integration points of one triangle.
inline constexpr int kMaxGroundPoints = 6;

/// Of ground that is not level.
using ProfilePointList = std::array<GroundPoint, 64 * kMaxGroundPoints>;

/// Integration points of the part of triangle x with z < 0; returns how many.
int ground_points(const std::array<Vec3, 3>& x, std::array<GroundPoint, kMaxGroundPoints>& out);

/// Integration points of the part of triangle x in the ground: as above where that is level, else the middles of 64
/// equal parts of the triangle. Triangles that stand along x, such as the sides of a wheel,
/// press nothing. Returns how many.
int profile_points(const GroundProfile& profile, const std::array<Vec3, 3>& x, ProfilePointList& out);

/// Normal force on the surface at one point that moves with velocity v; appends it to `contacts` unless there is none.
/// @returns it, N
double add_ground_force(const GroundLaw& law, int triangle, const GroundPoint& at, const Vec3& position,
                        const Vec3& velocity, std::vector<SurfaceContactForce>& contacts);

}  // namespace furrow::terrain
