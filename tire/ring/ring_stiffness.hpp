// How the ground of a pressed ring resists small motions d along x and z when the belt
// sticks to it wherever it touches.
//
// Segments that touch go with the ground, u_c = D d, and corners hold the belt where it lies over them, W u = d. The
// rest moves to where its forces vanish,
//   K_ff u_f + τ 1_f − W_fᵀ μ = −K_fc D d,   τ = γ (1·u),                                                      (1)
// with the tangent K of belt and sidewall and the air's rank of one γ. The ground's force is Dᵀ of what is left on
// the segments that touch, and Σ μ. Corners have no curvature here: the belt does not slide over them.
#pragma once

#include <Eigen/Core>

#include "tire/ring/ring_solver.hpp"

namespace furrow::tire {

/// Force that moves the ground by its way along x and z, N/m. @pre the solver has found an equilibrium
Eigen::Matrix2d ring_ground_stiffness(const RingSolver& solver);

}  // namespace furrow::tire
