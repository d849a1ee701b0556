// Sparse Cholesky factors (CHOLMOD) of a symmetric matrix on the free nodes of a ring, assembled element by
// element. The pattern is analysed once; several numeric factors ("slots") share it. A factor made in one
// orientation and numbering is used in another by turning and shifting right-hand side and solution:
//   A(q turned by Q, columns shifted by m) = P_m Q A Qᵀ P_mᵀ  exactly, because strain energy and mass are
//   objective.
#pragma once

#include <memory>
#include <vector>

#include "tire/ancf/panel_solver.hpp"
#include "tire/ancf/ring_layout.hpp"
#include "tire/ancf/shell_tangent.hpp"
#include "tire/ring_mesh.hpp"

namespace furrow {

class RingFactor {
 public:
  RingFactor(const RingLayout& layout, int slots);
  ~RingFactor();
  RingFactor(const RingFactor&) = delete;
  RingFactor& operator=(const RingFactor&) = delete;

  int unknowns() const { return pattern_.size(); }
  /// Entries of a factor that are stored, with padding.
  std::size_t factor_values() const { return pattern_.values(); }
  void clear();
  /// Adds the lanes of a batch that are elements: tangent plus mass_factor × M_e.
  void add(const BatchTangent& tangent, const ElementMass& mass, double mass_factor, int j, int batch);
  /// @returns false when the matrix is not positive definite
  bool factorize(int slot);
  /// x = turn · shift · A⁻¹ · (turn · shift)ᵀ rhs on the free rows; padding of x is zero there.
  void solve(int slot, const Mat3& turn, int shift, const Field& rhs, Field& x);

 private:
  std::size_t column_start(int node, int c) const;

  struct Cholmod;  // matrix and factor in double precision
  RingLayout layout_;
  std::unique_ptr<Cholmod> cholmod_;
  PanelPattern pattern_;
  std::vector<std::vector<float>> slots_;
  std::vector<int> place_;  // of an unknown in the factor's order
  std::vector<float> x_, work_;
  std::vector<std::vector<int>> neighbours_;  // free nodes ≥ own number that share an element, ascending
  std::vector<std::size_t> start_;            // first entry of each node's columns
};

}  // namespace furrow
