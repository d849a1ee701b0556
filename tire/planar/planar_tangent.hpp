// Tangent stiffness of the triangles of planar_elements.hpp, and the largest stable step of their explicit integration.
//
// With P = μ (F − F⁻ᵀ) + p J F⁻ᵀ, p = κ (J − 1/J), undeformed and deformed shape gradients ∇N and q = F⁻ᵀ ∇N,
//   K_ab = A b [ μ (∇N_a·∇N_b) I + α q_b q_aᵀ + β q_a q_bᵀ ],   α = μ − κ (J² − 1),   β = 2 κ J².               (1)
// With averaged volumes, α = μ − p̄ J, β = p̄ J, and each patch adds b A_p U''(J_p) g gᵀ, g = ∂J_p/∂x.
//
// Limit: no mode of the assembled mesh is faster than the fastest element or more damped than the most damped element,
// each with a third of its own mass at each corner. For v += (F/m) h, x += v h and the largest eigenvalues k of
// stiffness and c of damping over mass,
//   4 − 2 c h − k h² > 0,   h < 4 / (c + √(c² + 4k)),                                                           (2)
// which is 2/ω for an undamped mesh. It also bounds the fourth-order Runge–Kutta method from below (2.83/ω undamped).
#pragma once

#include <Eigen/Core>

#include "tire/planar/planar_elements.hpp"

namespace furrow::tire {

/// Rows and columns: x, z of the three corners.
using PlanarMatrix = Eigen::Matrix<double, 6, 6>;

/// (1), N/m. @param pressure volumetric() of the element; used with averaged volumes
PlanarMatrix element_tangent(const PlanarElements& elements, const PlanarField& x, int element, double pressure);

/// ∂(A J)/∂x of the corners of an element, m. The element's part of g is this / (3 A_p).
Eigen::Matrix<double, 6, 1> volume_gradient(const PlanarElements& elements, const PlanarField& x, int element);

/// h of (2) in this shape, s; a lower bound with averaged volumes.
double step_limit(const PlanarElements& elements, const PlanarField& x);

}  // namespace furrow::tire
