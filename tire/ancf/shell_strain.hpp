// Strains of the layered four-node ANCF shell with gradient-deficient bilinear interpolation,
//   r(ξ, η, z) = Σ N_n(ξ, η) (r_n + z d_n),
// as 36 generalised strains per element. With a₁ = ∂r_m/∂ξ, d₁ = ∂d/∂ξ (linear in η only) and a₂, d₂ = ∂/∂η
// (linear in ξ only), the covariant Green–Lagrange strain E_ij = ½ (g_i·g_j − G_i·G_j) is
//   E_11      = [½ a₁·a₁] + z [a₁·d₁] + z² [½ d₁·d₁]               at η = ∓1/√3
//   E_22      = [½ a₂·a₂] + z [a₂·d₂] + z² [½ d₂·d₂]               at ξ = ∓1/√3
//   2E_12     = [a₁·a₂] + z [a₁·d₂ + d₁·a₂] + z² [d₁·d₂]           at the four Gauss points
//   E_33      = [½ d·d] at the corners, bilinear between (assumed natural strain [Betsch & Stein 1995])
//   2E_13     = [a₁·d] + z [d₁·d] at η = ∓1, ξ = 0, linear in η    (the same [Dvorkin & Bathe 1984])
//   2E_23     = [a₂·d] + z [d₂·d] at ξ = ∓1, η = 0, linear in ξ
// each less its value in the curved reference. Every strain is a quadratic form ½ Σ_x q_xᵀ H_k q_x of the
// scalar unknowns q_x = (r_0, d_0, …, r_3, d_3)_x, x = 1…3, with constant 8 × 8 matrices H_k.
//   Yamashita, Valkeapää, Jayakumar, Sugiyama (2015), Continuum mechanics based bilinear shear deformable
//   shell element using absolute nodal coordinate formulation, J. Comput. Nonlinear Dyn. 10(5),
//   doi:10.1115/1.4028657.
#pragma once

#include <array>

#include "protocol/core/vec.hpp"

namespace furrow::tire {

inline constexpr int kStrains = 36;
inline constexpr double kGaussPoint = 0.57735026918962576451;  // 1/√3

// Index of the first power (z⁰) of each sampled component; the next powers follow.
inline constexpr int e11(int k) { return 3 * k; }      // Gauss point k in η
inline constexpr int e22(int l) { return 6 + 3 * l; }  // Gauss point l in ξ
inline constexpr int e12(int k, int l) { return 12 + 3 * (2 * k + l); }
inline constexpr int e33(int n) { return 24 + n; }      // corner n
inline constexpr int e13(int b) { return 28 + 2 * b; }  // edge η = −1, +1
inline constexpr int e23(int s) { return 32 + 2 * s; }  // edge ξ = −1, +1

using NodeMatrix = Eigen::Matrix<double, 8, 8>;    // index 2n + s: corner n, s = 0 position, 1 director
using ElementNodes = Eigen::Matrix<double, 8, 3>;  // unknowns of one element, same index
using StrainVector = Eigen::Matrix<double, kStrains, 1>;
using StrainMatrix = Eigen::Matrix<double, kStrains, kStrains, Eigen::RowMajor>;

/// H_k of all strains.
const std::array<NodeMatrix, kStrains>& strain_forms();

/// ½ Σ qᵀ H_k q: the strains before the reference is subtracted.
StrainVector raw_strains(const ElementNodes& q);

/// Maps generalised strains to the covariant components 11, 22, 2·12, 33, 2·13, 2·23 at a Gauss point (ξ = ∓1/√3 for l
/// = 0, 1, and η = ∓1/√3 for k = 0, 1) and height z.
Eigen::Matrix<double, 6, kStrains> covariant_map(int k, int l, double z);

}  // namespace furrow::tire
