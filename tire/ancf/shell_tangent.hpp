// Symmetric tangent of one batch of elements with respect to its nodal coordinates:
//   K = c_m Bᵀ D̂ B + c_g (Σ_k S_k H_k ⊗ I₃ − p ∂²V/∂r²)
// The pressure part is symmetrised element by element: the parts left out cancel between neighbours, and at
// the beads they belong to prescribed coordinates. Coordinate order in an element: 6 n + 3 s + x.
#pragma once

#include "protocol/core/simd.hpp"
#include "tire/ancf/shell_strain.hpp"

namespace furrow::tire {

using namespace simd;

struct BatchNodes;

struct BatchTangent {
  Double4 k[24][24];  // lower triangle

  void compute(const StrainMatrix& d, const BatchNodes& nodes, const Double4* stress, double material, double geometric,
               double pressure);
};

}  // namespace furrow::tire
