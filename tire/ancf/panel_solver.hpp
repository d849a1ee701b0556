// Triangular solves with a supernodal Cholesky factor in single precision.
//
// A solve reads the factor twice and computes little: its cost is memory traffic. So the factor is kept in single
// precision; it corrects a residual that is computed in double precision. Each supernode is a panel that both solves
// read from front to back:
//   panel = [L₁₁⁻¹; L₂₁], in strips of kStrip rows, column by column within a strip.
// As the diagonal block is inverted, there is no recurrence inside a panel: both solves are products.
//   forward:   x₁ ← L₁₁⁻¹ x₁,  x₂ ← x₂ − L₂₁ x₁        backward:  x₁ ← L₁₁⁻ᵀ (x₁ − L₂₁ᵀ x₂)
//
// The elimination tree is cut into branches, which threads share, and a trunk, solved after them (forward) or before
// them (backward). Each branch sums its own contribution to the trunk. The cut depends on the pattern alone, so that
// results have the same bits for any number of threads.
#pragma once

#include <vector>

namespace furrow::tire {

/// Rows and columns of a factor's supernodes; all factors of one pattern share them.
class PanelPattern {
 public:
  struct Panel {
    int first = 0;         // column
    int columns = 0;       // how many
    int below = 0;         // rows of L₂₁
    int rows = 0;          // start of their numbers
    std::size_t data = 0;  // start of the panel in a factor's values
  };

  static constexpr int kBranches = 4;

  PanelPattern() = default;
  /// From CHOLMOD's supernodal factor: first columns, row lists and their starts.
  PanelPattern(int supernodes, const int* super, const int* row_start, const int* row_number);

  int size() const { return size_; }
  /// Length of a right-hand side with room for the branches' contributions to the trunk.
  int padded_size() const { return size_ + kBranches * trunk_columns_; }
  std::size_t values() const { return values_; }
  const std::vector<Panel>& panels() const { return panels_; }
  const int* rows(const Panel& panel) const { return row_.data() + panel.rows; }
  /// The panel that holds the first row below panel s; −1 for a root.
  int parent(int s) const { return parent_[s]; }
  /// Panels of a branch, and of the trunk, in the order of elimination.
  const std::vector<int>& branch(int b) const { return branch_[b]; }
  const std::vector<int>& trunk() const { return branch_[kBranches]; }

  /// Writes panel s of a factor: the inverse of its diagonal block, and its columns with L₂₁ below.
  void pack(int s, const float* inverse, const float* columns, std::vector<float>& values) const;

  /// x ← (L Lᵀ)⁻¹ x; x is padded_size() long; `work` is scratch memory, grown when needed.
  void solve(const std::vector<float>& values, float* x, std::vector<float>& work, int threads) const;

 private:
  void cut();
  void forward(const std::vector<int>& panels, const float* values, float* x, float* work) const;
  void backward(const std::vector<int>& panels, const float* values, float* x, float* work) const;
  std::size_t panel_values(int s) const;

  std::vector<Panel> panels_;
  std::vector<int> row_, parent_;
  std::vector<int> to_;  // as row_, but rows of the trunk are in the branch's own part of the padding
  std::vector<std::vector<int>> branch_;
  std::vector<int> trunk_column_;  // columns of the trunk
  int trunk_columns_ = 0;
  std::size_t values_ = 0, work_ = 0;
  int size_ = 0;
};

}  // namespace furrow::tire
