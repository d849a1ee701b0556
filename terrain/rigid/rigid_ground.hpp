// Rigid ground: the plane z = 0, fixed to the world. Hard-ground curves, and the baseline of every soil.
#pragma once

#include <memory>

#include "terrain/rigid/ground_options.hpp"
#include "terrain/terrain.hpp"

namespace furrow::terrain {

/// The plane z = 0 with the contact law of terrain/rigid/ground_pressure.hpp, evaluated at the middle of each substep
/// so that the work of a linear spring is exact. μ = min(terrain.friction, the surface's friction).
///
/// A rigid body of weight W bounces on it with the damping ratio ζ = d ω/(2κ), ω² = κ A/m with A the area in contact:
/// small for a heavy wheel with the default damping, which is chosen for the light vertices of a flexible tire.
/// A vertex of mass m that carries the area A and has no damping of its own is stable in explicit coupling while about
/// κ A H²/m < 0.23 and 1.25 κ H < d < 0.5 m/(A H); friction acts as a dashpot c μ p A while |v_t| ≪ 1/c.
/// The ground does not know the masses of what it carries and limits nothing.
///
/// @throws Error(bad_input) when a stiffness, damping, friction or velocity scale is negative or not finite.
std::unique_ptr<Terrain> make_rigid_ground(const GroundOptions& options);

}  // namespace furrow::terrain
