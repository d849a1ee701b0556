// Cholesky factor of a sparse symmetric matrix that can be renewed in part.
//
// Multifrontal method [Duff & Reid 1983, The multifrontal solution of indefinite sparse symmetric linear equations, ACM
// Trans. Math. Softw. 9, doi:10.1145/356044.356047]: each supernode of the elimination tree adds its entries of the
// matrix and its children's Schur complements, eliminates its own columns, and passes its Schur complement to its
// parent. Schur complements are kept: when entries of the matrix change, only the supernodes that hold them and those
// above are computed again. The result does not depend on earlier renewals: a factor made at once has the same bits.
//
// Single precision: the factor corrects a residual that is computed in double precision.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tire/ancf/panel_solver.hpp"

namespace furrow::tire {

class FrontalFactor {
 public:
  /// One entry of the matrix: the index of its value in `values` of factorize, its row and column in the order of
  /// elimination (row ≥ column), and the group of entries with which it changes.
  struct Entry {
    int value = 0, row = 0, column = 0, group = 0;
  };

  FrontalFactor() = default;
  /// Entries with the same row and column are summed in the order given.
  /// @pre row ≥ column and group < groups in each of them
  FrontalFactor(PanelPattern pattern, const std::vector<Entry>& entries, int groups);

  /// Computes the supernodes that depend on the groups marked in `changed`; `threads` share the pattern's branches.
  /// @returns false when the matrix is not positive definite; the factor is then unusable until all groups are renewed
  bool factorize(std::span<const float> values, std::span<const char> changed, int threads);

  /// x ← A⁻¹ x; x is pattern().padded_size() long.
  void solve(float* x, int threads) { pattern_.solve(factor_, x, work_, threads); }

  const PanelPattern& pattern() const { return pattern_; }
  /// Floating point operations of the last factorize, and of a complete one.
  double operations() const { return operations_; }
  double all_operations() const { return all_operations_; }

 private:
  struct Place {
    int value = 0;
    int at = 0;  // row + rows of the front × column
  };
  /// Scratch memory of a branch.
  struct Front {
    std::vector<float> columns, inverse;
    double operations = 0.0;
    bool failed = false;
  };
  void eliminate(const std::vector<int>& supernodes, std::span<const float> values, Front& front);
  bool eliminate(int s, std::span<const float> values, Front& front);
  void gather(int s, std::span<const float> values, std::vector<float>& columns);

  PanelPattern pattern_;
  std::vector<std::vector<int>> children_;
  std::vector<std::vector<int>> place_in_parent_;  // of the rows below, in the parent's front
  std::vector<std::vector<Place>> entries_;        // of each supernode
  std::vector<std::vector<char>> holds_;           // [supernode][group]
  std::vector<std::vector<float>> passed_;         // Schur complement of each supernode, lower triangle by columns
  std::vector<char> dirty_;
  std::vector<float> factor_, work_;
  std::vector<Front> fronts_;  // of each branch
  double operations_ = 0.0, all_operations_ = 0.0;
};

}  // namespace furrow::tire
