#include "tire/ancf/frontal_factor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>

namespace furrow {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXf>;

/// Multiplications of a supernode with c columns and b rows below.
double supernode_operations(double c, double b) { return c * c * c / 3.0 + b * c * c + b * b * c; }

}  // namespace

FrontalFactor::FrontalFactor(PanelPattern pattern, const std::vector<Entry>& entries, int groups)
    : pattern_(std::move(pattern)) {
  const auto& panels = pattern_.panels();
  const int count = static_cast<int>(panels.size());
  std::vector<int> supernode_of(pattern_.size());
  for (int s = 0; s < count; ++s)
    for (int k = 0; k < panels[s].columns; ++k) supernode_of[panels[s].first + k] = s;
  parent_.assign(count, -1);
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
    parent_[s] = supernode_of[pattern_.rows(p)[0]];
    children_[parent_[s]].push_back(s);
    for (int k = 0; k < p.below; ++k) place_in_parent_[s].push_back(place(parent_[s], pattern_.rows(p)[k]));
  }
  for (const Entry& e : entries) {
    const int s = supernode_of[e.column];
    const auto& p = panels[s];
    entries_[s].push_back({e.value, place(s, e.row) + (p.columns + p.below) * (e.column - p.first)});
    holds_[s][e.group] = 1;
  }
  front_.resize(largest);
  inverse_.resize(widest * widest);
}

bool FrontalFactor::factorize(std::span<const float> values, std::span<const char> changed) {
  operations_ = 0.0;
  const int count = static_cast<int>(dirty_.size());
  std::fill(dirty_.begin(), dirty_.end(), 0);
  for (int s = 0; s < count; ++s) {
    for (std::size_t g = 0; g < changed.size(); ++g) dirty_[s] |= changed[g] & holds_[s][g];
    if (!dirty_[s]) continue;
    if (parent_[s] >= 0) dirty_[parent_[s]] = 1;
    if (!eliminate(s, values)) return false;
  }
  return true;
}

/// The columns of supernode s in front_, what its children pass on to rows below in passed_[s].
void FrontalFactor::gather(int s, std::span<const float> values) {
  const auto& p = pattern_.panels()[s];
  const int rows = p.columns + p.below;
  std::fill(front_.begin(), front_.begin() + static_cast<std::size_t>(rows) * p.columns, 0.0f);
  std::fill(passed_[s].begin(), passed_[s].end(), 0.0f);
  for (const Place& e : entries_[s]) front_[e.at] += values[e.value];
  for (const int child : children_[s]) {
    const std::vector<int>& to = place_in_parent_[child];
    const int n = static_cast<int>(to.size());
    for (int c = 0; c < n; ++c) {
      const float* from = passed_[child].data() + static_cast<std::size_t>(c) * n;
      float* column =
          to[c] < p.columns
              ? front_.data() + static_cast<std::size_t>(to[c]) * rows
              : passed_[s].data() + static_cast<std::size_t>(to[c] - p.columns) * p.below - p.columns;
      for (int r = c; r < n; ++r) column[to[r]] += from[r];
    }
  }
}

bool FrontalFactor::eliminate(int s, std::span<const float> values) {
  const auto& p = pattern_.panels()[s];
  gather(s, values);
  operations_ += supernode_operations(p.columns, p.below);
  Matrix panel(front_.data(), p.columns + p.below, p.columns);
  Eigen::Ref<Eigen::MatrixXf> top = panel.topRows(p.columns);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> llt(top);
  if (llt.info() != Eigen::Success) return false;
  Matrix inverse(inverse_.data(), p.columns, p.columns);
  inverse.setIdentity();
  top.triangularView<Eigen::Lower>().solveInPlace(inverse);
  inverse.triangularView<Eigen::StrictlyUpper>().setZero();
  if (p.below > 0) {
    Matrix passed(passed_[s].data(), p.below, p.below);
    top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel.bottomRows(p.below));
    passed.selfadjointView<Eigen::Lower>().rankUpdate(panel.bottomRows(p.below), -1.0f);
  }
  pattern_.pack(s, inverse_.data(), front_.data(), factor_);
  return true;
}

}  // namespace furrow
