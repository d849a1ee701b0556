// Friction of one tread vertex on the resting ground: regularised Coulomb friction behind the shear of the ground's
// elastic layer,
//
//   F = −A (κ_t ξ + d (v − s)) = −μ N tanh(c |s|) s/|s|,   ξ̇ = v − s,
//
// v the vertex's velocity along the ground, s the part of it that slides, ξ the shear of the layer, N and A load and
// area of the vertex. In steady sliding s = v: the law F = μ N tanh(c |v|) of the report [Recuero et al. 2016, Wheeled
// vehicle mobility studies in Chrono, SBEL technical report].
// By itself that law is a dashpot c μ N; on a tread vertex of 2 g under 50 N one step of 4e-5 s would stop it four
// times over, and forces that come one step late drive a chatter of ±1 m/s. Behind the shear the sliding is solved
// within the step (as friction is in brush models of tires [Pacejka, Tire and Vehicle Dynamics, 2012, ch. 3]).
#pragma once

#include "protocol/core/vec.hpp"
#include "terrain/rigid/ground_pressure.hpp"

namespace furrow::terrain {

/// Advances the shear ξ (m, z = 0) of a vertex over dt and returns the force on it, N.
/// @param load N ≥ 0, N; @param area A, m²; @param velocity m/s, its z is ignored
/// @param grip if not null: the share of the layer's stiffness κ_t A and damping d A that the vertex still feels along
/// its motion, from 1 (sticks) to 0 (slides)
/// @pre load ≥ 0, area ≥ 0, dt > 0
Vec3 slide(const GroundLaw& law, double load, double area, const Vec3& velocity, double dt, Vec3& shear,
           double* grip = nullptr);

}  // namespace furrow::terrain
