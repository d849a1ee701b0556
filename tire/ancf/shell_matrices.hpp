// Stiffness of one layered shell element in terms of its 36 generalised strains, integrated once at set-up:
//   W = ½ eᵀ D̂ e,  D̂ = D − Lᵀ K_αα⁻¹ L
//   D    = Σ_layers ∫ Nᵀ Tᵀ C T N j dξ dη dz,   L = Σ_layers ∫ Gᵀ C T N j dξ dη dz
//   K_αα = Σ_layers ∫ Gᵀ C G j dξ dη dz
// with N the covariant map, T(ξ, η, z) from covariant components to material axes, and j = det J₀(z).
// The enhanced strain G α = (j₀/j) T₀ M(ξ, η, ζ) α holds one set of parameters for the whole element, each of zero
// mean: ξ on 11, η on 22, ξ and η on 12, and ζ (1, ξ, η, ξη) on 33. As the material is linear, α is eliminated exactly.
//   Simo & Rifai (1990), A class of mixed assumed strain methods, Int. J. Numer. Methods Eng. 29,
//   doi:10.1002/nme.1620290802.
#pragma once

#include <vector>

#include "tire/ancf/shell_strain.hpp"
#include "tire/tire_file.hpp"

namespace furrow::tire {

inline constexpr int kEnhanced = 8;

/// A layer with its stiffness in material axes (order xx, yy, 2xy, zz, 2xz, 2yz), from the inside outwards.
struct ShellLayer {
  double thickness = 0.0;                 // m
  double angle = 0.0;                     // of the fibre from g₁ towards g₂, rad
  Eigen::Matrix<double, 6, 6> stiffness;  // Pa
};

/// One quadrature point: strains in material axes are strain_map · e + enhanced_map · α.
struct ShellPoint {
  Eigen::Matrix<double, 6, kStrains> strain_map;
  Eigen::Matrix<double, 6, kEnhanced> enhanced_map;
  double volume = 0.0;  // weight × j, m³
  int layer = 0;
};

/// 2 × 2 Gauss points in the plane, three through each layer.
std::vector<ShellPoint> shell_points(const ElementNodes& reference, const std::vector<ShellLayer>& layers);

/// D̂, J; `reference` holds the undeformed corners and directors.
StrainMatrix shell_stiffness(const ElementNodes& reference, const std::vector<ShellLayer>& layers);

std::vector<ShellLayer> shell_layers(const TireFile& file, const Section& section);

}  // namespace furrow::tire
