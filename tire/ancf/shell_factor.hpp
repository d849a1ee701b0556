// Cholesky factor of a symmetric matrix on the free nodes of a ring, assembled element by element, in rim axes: strain
// energy and mass are objective. A factor made in one orientation of the rim is therefore used in another by turning
// right-hand side and solution,
//   A(q turned by Q) = Q A Qᵀ.
// The elements are held in sectors of kDoubleLanes columns; a factor is renewed in those sectors that have changed.
#pragma once

#include <memory>
#include <vector>

#include "tire/ancf/frontal_factor.hpp"
#include "tire/ancf/shell_layout.hpp"
#include "tire/ancf/shell_tangent.hpp"
#include "tire/shell_mesh.hpp"

namespace furrow::tire {

class ShellFactor {
 public:
  explicit ShellFactor(const ShellLayout& layout);

  int sectors() const { return layout_.batches(); }
  /// Forgets the elements of a sector. @pre 0 ≤ sector < sectors(), here and in what follows
  void clear(int sector);
  /// Adds the elements of row j of a sector: tangent plus mass_factor × M_e.
  void add(const BatchTangent& tangent, const ElementMass& mass, double mass_factor, int j, int sector);
  /// Adds a symmetric stiffness of the positions of a free node, `lane` columns into a sector, in rim axes.
  void add_node(const Mat3& stiffness, int sector, int lane, int row);
  /// Renews the factor where sectors were cleared and added since it was made.
  /// @returns false when the matrix is not positive definite
  bool factorize(int threads = 1);
  /// Share of a whole factorization that the last one took.
  double work() const { return factor_.operations() / factor_.all_operations(); }
  /// x = turn A⁻¹ turnᵀ rhs on the free rows; padding of x is zero there.
  void solve(const Mat3& turn, const Field& rhs, Field& x, int threads = 1);

 private:
  std::size_t block(int sector, int column, int row, int kind) const;

  ShellLayout layout_;
  int across_ = 0;             // free nodes of a column
  std::vector<int> place_;     // of an unknown in the order of elimination
  std::vector<float> values_;  // 6 × 6 blocks of each sector
  std::vector<char> changed_;  // sectors
  FrontalFactor factor_;
  std::vector<float> x_;
};

}  // namespace furrow::tire
