// Stiffness of a pressed ring against small motions d of its ground along x and z. The belt sticks wherever it touches.
//
// Touching segments move with the ground, u_c = D d, and so does the belt over corners, W u = d. The other segments
// move until their forces vanish,
//   K_ff u_f + τ 1_f − W_fᵀ μ = −K_fc D d,   τ = γ (1·u),                                                      (1)
// with the tangent K of belt and sidewall and the air's γ. The ground's force is Dᵀ times the residual on the touching
// segments, plus Σ μ. Corners have no curvature here: the belt does not slide over them.
#pragma once

#include <Eigen/Core>

#include "tire/ring/ring_solver.hpp"

namespace furrow::tire {

/// Force that moves the ground over its displacement along x and z, N/m. @pre the solver has found an equilibrium
Eigen::Matrix2d ring_ground_stiffness(const RingSolver& solver);

}  // namespace furrow::tire
