#include "tire/ancf/panel_solver.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"
#include "protocol/core/simd.hpp"

namespace furrow::tire {
namespace {

constexpr int kStrip = 16;  // rows
using simd::Float8;
using simd::kFloatLanes;

int strips(int rows) { return (rows + kStrip - 1) / kStrip; }
/// Columns of strip s of the inverse of a diagonal block: it is lower triangular.
int triangle_columns(int s, int columns) { return std::min(columns, (s + 1) * kStrip); }

std::size_t triangle_values(int columns) {
  std::size_t total = 0;
  for (int s = 0; s < strips(columns); ++s) total += kStrip * triangle_columns(s, columns);
  return total;
}

/// y (kStrip long) = strip · x
const float* multiply(const float* a, int columns, const float* x, float* y) {
  Float8 s0 = {}, s1 = {}, t0 = {}, t1 = {};
  int k = 0;
  for (; k + 1 < columns; k += 2, a += 2 * kStrip) {
    s0 += x[k] * simd::load(a), s1 += x[k] * simd::load(a + kFloatLanes);
    t0 += x[k + 1] * simd::load(a + kStrip), t1 += x[k + 1] * simd::load(a + kStrip + kFloatLanes);
  }
  if (k < columns) {
    s0 += x[k] * simd::load(a), s1 += x[k] * simd::load(a + kFloatLanes);
    a += kStrip;
  }
  simd::store(y, s0 + t0), simd::store(y + kFloatLanes, s1 + t1);
  return a;
}

/// Adds to the kFloatLanes partial sums of each of the columns of y = stripᵀ · x.
const float* multiply_transposed(const float* a, int columns, const float* x, float* y) {
  const Float8 x0 = simd::load(x), x1 = simd::load(x + kFloatLanes);
  for (int k = 0; k < columns; ++k, a += kStrip)
    simd::store(y + kFloatLanes * k,
                simd::load(y + kFloatLanes * k) + (simd::load(a) * x0 + simd::load(a + kFloatLanes) * x1));
  return a;
}

}  // namespace

PanelPattern::PanelPattern(int supernodes, const int* super, const int* row_start, const int* row_number) {
  FURROW_ASSERT(supernodes > 0 && super != nullptr, supernodes);
  FURROW_ASSERT(row_start != nullptr && row_number != nullptr, supernodes);
  int widest = 0, tallest = 0;
  for (int s = 0; s < supernodes; ++s) {
    Panel panel;
    panel.first = super[s];
    panel.columns = super[s + 1] - super[s];
    panel.below = row_start[s + 1] - row_start[s] - panel.columns;
    panel.rows = static_cast<int>(row_.size());
    panel.data = values_;
    row_.insert(row_.end(), row_number + row_start[s] + panel.columns, row_number + row_start[s + 1]);
    values_ += triangle_values(panel.columns) + static_cast<std::size_t>(kStrip) * strips(panel.below) * panel.columns;
    widest = std::max(widest, panel.columns);
    tallest = std::max(tallest, panel.below);
    panels_.push_back(panel);
  }
  size_ = super[supernodes];
  work_ = kStrip * static_cast<std::size_t>(strips(widest) + strips(tallest)) +
          kFloatLanes * static_cast<std::size_t>(widest) + 4 * kStrip;
  std::vector<int> panel_of(size_);
  for (int s = 0; s < supernodes; ++s) std::fill_n(panel_of.begin() + panels_[s].first, panels_[s].columns, s);
  for (const Panel& p : panels_) parent_.push_back(p.below > 0 ? panel_of[rows(p)[0]] : -1);
  cut();
}

std::size_t PanelPattern::panel_values(int s) const {
  FURROW_ASSERT(in_range(s, panels_.size()), s, panels_.size());
  const Panel& p = panels_[s];
  return triangle_values(p.columns) + static_cast<std::size_t>(kStrip) * strips(p.below) * p.columns;
}

/// Distributes subtrees of at most 1/(2 kBranches) of the factor to the branches, the largest first. The columns above
/// them are the trunk.
void PanelPattern::cut() {
  const int count = static_cast<int>(panels_.size());
  std::vector<std::size_t> weight(count, 0);  // of the subtree
  std::vector<std::vector<int>> children(count);
  std::vector<int> whole;            // roots of subtrees
  for (int s = 0; s < count; ++s) {  // children come before their parents
    weight[s] += panel_values(s);
    if (parent_[s] < 0) {
      whole.push_back(s);
    } else {
      weight[parent_[s]] += weight[s];
      children[parent_[s]].push_back(s);
    }
  }
  const auto heavier = [&](int a, int b) { return weight[a] != weight[b] ? weight[a] > weight[b] : a < b; };
  std::vector<int> owner(count, kBranches);
  while (!whole.empty()) {
    const auto most = std::min_element(whole.begin(), whole.end(), heavier);
    if (weight[*most] <= values_ / (2 * kBranches)) break;
    const std::vector<int> parts = children[*most];
    whole.erase(most);
    whole.insert(whole.end(), parts.begin(), parts.end());
  }
  std::sort(whole.begin(), whole.end(), heavier);
  std::size_t load[kBranches] = {};
  for (const int root : whole) {
    owner[root] = static_cast<int>(std::min_element(load, load + kBranches) - load);
    load[owner[root]] += weight[root];
  }
  branch_.resize(kBranches + 1);
  for (int s = count; s-- > 0;)
    if (owner[s] == kBranches && parent_[s] >= 0) owner[s] = owner[parent_[s]];
  std::vector<int> place(size_, -1);
  for (int s = 0; s < count; ++s) {
    branch_[owner[s]].push_back(s);
    for (int k = 0; k < panels_[s].columns && owner[s] == kBranches; ++k) {
      place[panels_[s].first + k] = trunk_columns_++;
      trunk_column_.push_back(panels_[s].first + k);
    }
  }
  to_ = row_;
  for (int s = 0; s < count; ++s)
    for (int k = 0; k < panels_[s].below && owner[s] < kBranches; ++k) {
      int& row = to_[panels_[s].rows + k];
      if (place[row] >= 0) row = size_ + owner[s] * trunk_columns_ + place[row];
    }
}

void PanelPattern::pack(int s, const float* inverse, const float* columns, std::vector<float>& values) const {
  const Panel& p = panels_[s];
  float* to = values.data() + p.data;
  for (int first = 0; first < p.columns; first += kStrip)
    for (int k = 0; k < triangle_columns(first / kStrip, p.columns); ++k)
      for (int r = first; r < first + kStrip; ++r)
        *to++ = r < p.columns ? inverse[r + static_cast<std::size_t>(k) * p.columns] : 0.0f;
  for (int first = 0; first < p.below; first += kStrip)
    for (int k = 0; k < p.columns; ++k) {
      const float* from = columns + static_cast<std::size_t>(k) * (p.columns + p.below) + p.columns;
      for (int r = first; r < first + kStrip; ++r) *to++ = r < p.below ? from[r] : 0.0f;
    }
}

void PanelPattern::forward(const std::vector<int>& panels, const float* values, float* x, float* work) const {
  float y[kStrip];
  for (const int n : panels) {
    const Panel& p = panels_[n];
    const float* a = values + p.data;
    for (int s = 0; s < strips(p.columns); ++s)
      a = multiply(a, triangle_columns(s, p.columns), x + p.first, work + s * kStrip);
    std::copy(work, work + p.columns, x + p.first);
    const int* row = to_.data() + p.rows;
    for (int s = 0; s < p.below; s += kStrip) {
      a = multiply(a, p.columns, x + p.first, y);
      const int count = std::min(kStrip, p.below - s);
      for (int r = 0; r < count; ++r) x[row[s + r]] -= y[r];
    }
  }
}

void PanelPattern::backward(const std::vector<int>& panels, const float* values, float* x, float* work) const {
  for (std::size_t n = panels.size(); n-- > 0;) {
    const Panel& p = panels_[panels[n]];
    float* partial = work;
    std::fill(partial, partial + kFloatLanes * p.columns, 0.0f);
    const float* triangle = values + p.data;
    const float* a = triangle + triangle_values(p.columns);
    const int* row = rows(p);
    float gathered[kStrip];
    for (int s = 0; s < p.below; s += kStrip) {
      for (int r = 0; r < kStrip; ++r) gathered[r] = s + r < p.below ? x[row[s + r]] : 0.0f;
      a = multiply_transposed(a, p.columns, gathered, partial);
    }
    float* own = work + kFloatLanes * p.columns;
    for (int k = 0; k < p.columns; ++k) own[k] = x[p.first + k] - simd::sum(simd::load(partial + kFloatLanes * k));
    std::fill(own + p.columns, own + strips(p.columns) * kStrip, 0.0f);
    std::fill(partial, partial + kFloatLanes * p.columns, 0.0f);
    for (int s = 0; s < strips(p.columns); ++s)
      triangle = multiply_transposed(triangle, triangle_columns(s, p.columns), own + s * kStrip, partial);
    for (int k = 0; k < p.columns; ++k) x[p.first + k] = simd::sum(simd::load(partial + kFloatLanes * k));
  }
}

void PanelPattern::solve(const std::vector<float>& values, float* x, std::vector<float>& work, int threads) const {
  if (work.size() < kBranches * work_) work.resize(kBranches * work_);
  float* passed = x + size_;
#pragma omp parallel for schedule(static, 1) num_threads(std::min(threads, kBranches)) if (threads > 1)
  for (int b = 0; b < kBranches; ++b) {
    std::fill_n(passed + b * trunk_columns_, trunk_columns_, 0.0f);
    forward(branch_[b], values.data(), x, work.data() + b * work_);
  }
  for (int k = 0; k < trunk_columns_; ++k)
    for (int b = 0; b < kBranches; ++b) x[trunk_column_[k]] += passed[b * trunk_columns_ + k];
  forward(trunk(), values.data(), x, work.data());
  backward(trunk(), values.data(), x, work.data());
#pragma omp parallel for schedule(static, 1) num_threads(std::min(threads, kBranches)) if (threads > 1)
  for (int b = 0; b < kBranches; ++b) backward(branch_[b], values.data(), x, work.data() + b * work_);
}

}  // namespace furrow::tire
