// Classical laminate theory, also with the thickness strain of the element.
//   Jones (1999), Mechanics of Composite Materials, ch. 4; Reddy (2004), Mechanics of Laminated Composite Plates and
//   Shells, § 7.3 (Navier solutions of the first-order theory).
#pragma once

#include <vector>

#include "tire/ancf/shell_matrices.hpp"

namespace furrow::test {

/// [A B; B D] for ε = ε⁰ + z κ, order 11, 22, 12 (engineering); N/m, N, N m.
using Abd = Eigen::Matrix<double, 6, 6>;

/// σ₃₃ = 0 in every layer.
Abd plane_stress_abd(const std::vector<tire::ShellLayer>& layers);
/// ε₃₃ = a + b z through all layers with a, b from ∫ σ₃₃ dz = ∫ z σ₃₃ dz = 0.
Abd linear_thickness_abd(const std::vector<tire::ShellLayer>& layers);
/// ∫ C₁₃₁₃ dz and ∫ C₂₃₂₃ dz, N/m; correction factor 1.
std::pair<double, double> shear_stiffness(const std::vector<tire::ShellLayer>& layers);

/// Central deflection of a simply supported square cross-ply plate of side `a` under q sin(πx/a) sin(πy/a), first-order
/// theory with the shear stiffness multiplied by `factor`.
double navier_deflection(const Abd& abd, std::pair<double, double> shear, double factor, double a, double q);

}  // namespace furrow::test
