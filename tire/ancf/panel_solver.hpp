// Triangular solves with a supernodal Cholesky factor, single precision, laid out for them.
//
// A solve reads the factor twice and computes little: what it costs is memory traffic. So the factor is kept in single
// precision (it corrects a residual that is computed in double precision), and each supernode as a panel that both
// solves read from front to back:
//   panel = [L₁₁⁻¹; L₂₁], in strips of kStrip rows, column by column within a strip.
// With the diagonal block inverted there is no recurrence inside a panel: both solves are products.
//   forward:   x₁ ← L₁₁⁻¹ x₁,  x₂ ← x₂ − L₂₁ x₁        backward:  x₁ ← L₁₁⁻ᵀ (x₁ − L₂₁ᵀ x₂)
#pragma once

#include <vector>

namespace furrow {

/// Which rows and columns the supernodes of a factor have; shared by all factors of one pattern.
class PanelPattern {
 public:
  struct Panel {
    int first = 0;         // column
    int columns = 0;       // how many
    int below = 0;         // rows of L₂₁
    int rows = 0;          // where their numbers begin
    std::size_t data = 0;  // where the panel begins in a factor's values
  };

  PanelPattern() = default;
  /// From CHOLMOD's supernodal factor: first columns, row lists and their starts.
  PanelPattern(int supernodes, const int* super, const int* row_start, const int* row_number);

  int size() const { return size_; }
  std::size_t values() const { return values_; }
  const std::vector<Panel>& panels() const { return panels_; }
  const int* rows(const Panel& panel) const { return row_.data() + panel.rows; }

  /// Writes panel s of a factor: the inverse of its diagonal block, and its columns with L₂₁ below.
  void pack(int s, const float* inverse, const float* columns, std::vector<float>& values) const;

  /// x ← (L Lᵀ)⁻¹ x; `work` is scratch memory, grown when needed.
  void solve(const std::vector<float>& values, float* x, std::vector<float>& work) const;

 private:
  void forward(const float* values, float* x, float* work) const;
  void backward(const float* values, float* x, float* work) const;

  std::vector<Panel> panels_;
  std::vector<int> row_;
  std::size_t values_ = 0, work_ = 0;
  int size_ = 0;
};

}  // namespace furrow
