// Constant-strain triangles of a planar tire: nodal masses, internal forces, energies.
//
// With the matrices F_I and F_D of a triangle's two edge vectors, undeformed and deformed, and L_D that of their rates,
//   F = F_D F_I⁻¹,   L = L_D F_D⁻¹,   D = ½(L + Lᵀ),   T by planar_material.hpp (1).                            (1)
// A side gives each of its two nodes −½ T n b, with the width b and the outward normal n, as long as the side: a
// stretched triangle pulls its nodes together. So a node receives ½ T n b from the opposite side, which is
// −∂(A b W)/∂x. Nodal mass: ρ |F_I| b / 6 of each element.
//
// `averaged` replaces J in the volumetric part by its mean over the triangles around a node, weighted by their areas
// and taken within one material,
//   J_a = Σ A_e J_e / Σ A_e,   Π = b Σ_e A_e W_μ(F_e) + b Σ_a ⅓ Σ_e A_e · κ/2 (J_a² − 1 − 2 ln J_a),            (2)
// whose elements have the mean of their nodes' pressures [Bonet & Burton 1998]. Without averaging, constant-strain
// triangles lock when ν approaches ½.
//
// Data flow of force(): each element reads the positions of its nodes and writes six numbers, all in vectors. Then
// every node sums the numbers of its elements, in a fixed order. Nothing is allocated.
//
// Bonet, Burton, A simple average nodal pressure tetrahedral element, Communications in Numerical Methods in
// Engineering 14 (1998) 437, doi:10.1002/(SICI)1099-0887(199805)14:5<437::AID-CNM162>3.0.CO;2-W.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tire/planar/planar_material.hpp"
#include "tire/planar/planar_mesh.hpp"

namespace furrow::tire {

struct PlanarOptions {
  PlanarLaw law = PlanarLaw::consistent;
  bool averaged = false;  // the volume change is averaged around nodes
  double width = 1.0;     // b, m
};

/// Stress of an element, Pa.
struct PlanarStress {
  double xx = 0.0, xz = 0.0, zz = 0.0;
};

class PlanarElements {
 public:
  /// @param materials of the parts. @pre every triangle has a positive area and a part with a material
  PlanarElements(const PlanarMesh& mesh, std::span<const PlanarMaterial> materials, const PlanarOptions& options);

  int nodes() const { return static_cast<int>(mass_.size()); }
  int size() const { return static_cast<int>(mu_.size()); }
  const std::vector<double>& mass() const { return mass_; }  // of nodes, kg
  const PlanarOptions& options() const { return options_; }

  /// Internal force on nodes. @returns whether no triangle is turned inside out
  bool force(const PlanarField& x, const PlanarField& v, PlanarField& out);
  /// Elastic, J.
  double energy(const PlanarField& x) const;
  /// Power that viscosity dissipates, W; not negative.
  double viscous_power(const PlanarField& x, const PlanarField& v) const;
  /// Stress without its viscous part.
  PlanarStress stress(const PlanarField& x, int element) const;

  // Data of one element, for tangents and limits.
  struct Element {
    std::array<int, 3> node;
    double area, mu, kappa, viscosity, density;  // undeformed m², Pa, Pa, Pa s, kg/m³
    std::array<double, 4> inverse;               // of F_I, by rows, 1/m
  };
  Element element(int e) const;
  /// F by rows.
  std::array<double, 4> gradient(const PlanarField& x, int element) const;
  /// κ (J − 1/J), or its mean over the nodes, Pa.
  std::vector<double> volumetric(const PlanarField& x) const;

  /// For averaged volumes: a node with the triangles of one material around it.
  struct Patch {
    double kappa = 0.0, area = 0.0;  // Pa; third of the triangles' areas, m²
    std::vector<int> elements;
  };
  const std::vector<Patch>& patches() const { return patches_; }

 private:
  template <bool averaged>
  bool stresses(const PlanarField& x, const PlanarField& v);
  void average(const PlanarField& x);
  void gather(PlanarField& out) const;
  void make_patches(const PlanarMesh& mesh);

  PlanarOptions options_;
  std::vector<double> mass_;
  std::array<std::vector<int>, 3> node_;
  std::array<std::vector<double>, 4> inverse_;  // of F_I, by rows
  std::vector<double> area_, mu_, kappa_, viscosity_, density_;
  // Written by elements: forces on their corners 0, then on all corners 1, then 2, N.
  std::vector<double> push_x_, push_z_;
  // Read by nodes: entries size() × corner + element of node n, from first_[n] to first_[n + 1].
  std::vector<int> first_, entry_;
  // For averaged volumes.
  std::vector<Patch> patches_;
  std::array<std::vector<int>, 3> patch_;  // of an element's corners
  std::vector<double> volume_, pressure_;  // of elements: A J, m²; Pa
  std::vector<double> patch_pressure_;     // Pa
};

}  // namespace furrow::tire
