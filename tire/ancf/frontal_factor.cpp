#include "tire/ancf/frontal_factor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXf>;

/// Multiplications of a supernode with c columns and b rows below.
double supernode_operations(double c, double b) { return c * c * c / 3.0 + b * c * c + b * b * c; }

}  // namespace

FrontalFactor::FrontalFactor(PanelPattern pattern, const std::vector<Entry>& entries, int groups)
    : pattern_(std::move(pattern)) {
  FURROW_ASSERT(groups > 0, groups);
  FURROW_ASSERT(std::all_of(entries.begin(), entries.end(),
                            [&](const Entry& e) {
                              return e.row >= e.column && in_range(e.column, pattern_.size()) &&
                                     in_range(e.group, groups);
                            }),
                entries.size(), pattern_.size(), groups);
  const auto& panels = pattern_.panels();
  const int count = static_cast<int>(panels.size());
  std::vector<int> supernode_of(pattern_.size());
  for (int s = 0; s < count; ++s)
    for (int k = 0; k < panels[s].columns; ++k) supernode_of[panels[s].first + k] = s;
  children_.resize(count);
  place_in_parent_.resize(count);
  entries_.resize(count);
  holds_.assign(count, std::vector<char>(groups, 0));
  passed_.resize(count);
  dirty_.resize(count);
  factor_.assign(pattern_.values(), 0.0f);
  std::size_t largest = 0, widest = 0;
  const auto place = [&](int s, int row) {  // of a row in the front of s
    const auto& p = panels[s];
    if (row < p.first + p.columns) return row - p.first;
    const int* below = pattern_.rows(p);
    return p.columns + static_cast<int>(std::lower_bound(below, below + p.below, row) - below);
  };
  for (int s = 0; s < count; ++s) {
    const auto& p = panels[s];
    largest = std::max(largest, static_cast<std::size_t>(p.columns + p.below) * p.columns);
    widest = std::max(widest, static_cast<std::size_t>(p.columns));
    all_operations_ += supernode_operations(p.columns, p.below);
    passed_[s].assign(static_cast<std::size_t>(p.below) * p.below, 0.0f);
    if (p.below == 0) continue;
    const int parent = pattern_.parent(s);
    children_[parent].push_back(s);
    for (int k = 0; k < p.below; ++k) place_in_parent_[s].push_back(place(parent, pattern_.rows(p)[k]));
  }
  for (const Entry& e : entries) {
    const int s = supernode_of[e.column];
    const auto& p = panels[s];
    entries_[s].push_back({e.value, place(s, e.row) + (p.columns + p.below) * (e.column - p.first)});
    holds_[s][e.group] = 1;
  }
  fronts_.resize(PanelPattern::kBranches);
  for (Front& front : fronts_) {
    front.columns.resize(largest);
    front.inverse.resize(widest * widest);
  }
}

bool FrontalFactor::factorize(std::span<const float> values, std::span<const char> changed, int threads) {
  FURROW_ASSERT(holds_.empty() || changed.size() == holds_.front().size(), changed.size(), holds_.size());
  FURROW_ASSERT(threads > 0, threads);
  std::fill(dirty_.begin(), dirty_.end(), 0);
  for (std::size_t s = 0; s < dirty_.size(); ++s) {
    for (std::size_t g = 0; g < changed.size(); ++g) dirty_[s] |= changed[g] & holds_[s][g];
    if (const int parent = pattern_.parent(static_cast<int>(s)); dirty_[s] && parent >= 0) dirty_[parent] = 1;
  }
  for (Front& front : fronts_) front.operations = 0.0, front.failed = false;
  constexpr int branches = PanelPattern::kBranches;
#pragma omp parallel for schedule(static, 1) num_threads(std::min(threads, branches)) if (threads > 1)
  for (int b = 0; b < branches; ++b) eliminate(pattern_.branch(b), values, fronts_[b]);
  const auto failed = [](const Front& front) { return front.failed; };
  if (std::none_of(fronts_.begin(), fronts_.end(), failed)) eliminate(pattern_.trunk(), values, fronts_[0]);
  operations_ = 0.0;
  for (const Front& front : fronts_) operations_ += front.operations;
  return std::none_of(fronts_.begin(), fronts_.end(), failed);
}

void FrontalFactor::eliminate(const std::vector<int>& supernodes, std::span<const float> values, Front& front) {
  for (const int s : supernodes)
    if (dirty_[s] && !eliminate(s, values, front)) {
      front.failed = true;
      return;
    }
}

/// Gathers the columns of supernode s, and its children's contributions to the rows below in passed_[s].
void FrontalFactor::gather(int s, std::span<const float> values, std::vector<float>& columns) {
  FURROW_ASSERT(in_range(s, entries_.size()), s, entries_.size());
  FURROW_ASSERT(std::all_of(entries_[s].begin(), entries_[s].end(),
                            [&](const Place& e) { return in_range(e.value, values.size()); }),
                s, values.size());
  const auto& p = pattern_.panels()[s];
  const int rows = p.columns + p.below;
  std::fill(columns.begin(), columns.begin() + static_cast<std::size_t>(rows) * p.columns, 0.0f);
  std::fill(passed_[s].begin(), passed_[s].end(), 0.0f);
  for (const Place& e : entries_[s]) columns[e.at] += values[e.value];
  for (const int child : children_[s]) {
    const std::vector<int>& to = place_in_parent_[child];
    const int n = static_cast<int>(to.size());
    for (int c = 0; c < n; ++c) {
      const float* from = passed_[child].data() + static_cast<std::size_t>(c) * n;
      float* column = to[c] < p.columns
                          ? columns.data() + static_cast<std::size_t>(to[c]) * rows
                          : passed_[s].data() + static_cast<std::size_t>(to[c] - p.columns) * p.below - p.columns;
      for (int r = c; r < n; ++r) column[to[r]] += from[r];
    }
  }
}

bool FrontalFactor::eliminate(int s, std::span<const float> values, Front& front) {
  const auto& p = pattern_.panels()[s];
  gather(s, values, front.columns);
  front.operations += supernode_operations(p.columns, p.below);
  Matrix panel(front.columns.data(), p.columns + p.below, p.columns);
  Eigen::Ref<Eigen::MatrixXf> top = panel.topRows(p.columns);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> llt(top);
  if (llt.info() != Eigen::Success) return false;
  Matrix inverse(front.inverse.data(), p.columns, p.columns);
  inverse.setIdentity();
  top.triangularView<Eigen::Lower>().solveInPlace(inverse);
  inverse.triangularView<Eigen::StrictlyUpper>().setZero();
  if (p.below > 0) {
    Matrix passed(passed_[s].data(), p.below, p.below);
    top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel.bottomRows(p.below));
    passed.selfadjointView<Eigen::Lower>().rankUpdate(panel.bottomRows(p.below), -1.0f);
  }
  pattern_.pack(s, front.inverse.data(), front.columns.data(), factor_);
  return true;
}

}  // namespace furrow::tire
