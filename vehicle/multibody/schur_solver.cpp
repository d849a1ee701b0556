#include "vehicle/multibody/schur_solver.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kRegularization = 1e-9;  // ε relative to the largest diagonal entry of S

struct RowSide {
  int row;
  bool is_b;
};

}  // namespace

void SchurSolver::analyze(std::span<const Row> rows, const RateSides& rates) {
  FURROW_ASSERT(std::all_of(rows.begin(), rows.end(),
                            [](const Row& row) { return row.a >= kGround && row.b >= kGround && row.a != row.b; }),
                rows.size());
  int body_count = 0;
  for (const Row& row : rows) body_count = std::max({body_count, row.a + 1, row.b + 1});
  for (const SpinSide& side : rates.spins) body_count = std::max(body_count, side.body + 1);
  std::vector<std::vector<RowSide>> sides(body_count);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    if (rows[i].a != kGround) sides[rows[i].a].push_back({i, false});
    if (rows[i].b != kGround) sides[rows[i].b].push_back({i, true});
  }
  const int n = static_cast<int>(rows.size()) + rates.count;
  std::vector<Eigen::Triplet<double>> pattern;
  for (int i = 0; i < n; ++i) pattern.emplace_back(i, i, 0.0);
  entries_.clear();
  for (int body = 0; body < body_count; ++body)
    for (const RowSide& si : sides[body])
      for (const RowSide& sj : sides[body])
        if (si.row >= sj.row) {
          entries_.push_back({si.row, sj.row, 0, body, si.is_b, sj.is_b});
          pattern.emplace_back(si.row, sj.row, 0.0);
        }
  find_rate_entries(rows, rates, body_count);
  for (const SpinEntry& entry : spin_entries_) pattern.emplace_back(entry.i, entry.j, 0.0);
  for (const ShaftEntry& entry : shaft_entries_) pattern.emplace_back(entry.i, entry.j, 0.0);
  S_.resize(n, n);
  S_.setFromTriplets(pattern.begin(), pattern.end());
  S_.makeCompressed();
  const auto index_of = [&](int i, int j) {
    const auto* first = S_.innerIndexPtr() + S_.outerIndexPtr()[j];
    const auto* last = S_.innerIndexPtr() + S_.outerIndexPtr()[j + 1];
    return static_cast<int>(std::lower_bound(first, last, i) - S_.innerIndexPtr());
  };
  for (Entry& entry : entries_) entry.value = index_of(entry.i, entry.j);
  for (SpinEntry& entry : spin_entries_) entry.value = index_of(entry.i, entry.j);
  for (ShaftEntry& entry : shaft_entries_) entry.value = index_of(entry.i, entry.j);
  diagonal_.resize(n);
  for (int i = 0; i < n; ++i) diagonal_[i] = index_of(i, i);
  ldlt_.analyzePattern(S_);
}

void SchurSolver::find_rate_entries(std::span<const Row> rows, const RateSides& rates, int body_count) {
  FURROW_ASSERT(rates.count > 0 || (rates.spins.empty() && rates.shafts.empty()), rates.count);
  spin_entries_.clear();
  shaft_entries_.clear();
  if (rates.count == 0) return;
  struct Place {
    int row, side;
  };
  std::vector<std::vector<Place>> places(body_count);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    if (rows[i].a != kGround) places[rows[i].a].push_back({i, kSideA});
    if (rows[i].b != kGround) places[rows[i].b].push_back({i, kSideB});
  }
  for (int k = 0; k < static_cast<int>(rates.spins.size()); ++k)
    places[rates.spins[k].body].push_back({rates.spins[k].row, k});
  for (int body = 0; body < body_count; ++body)
    for (const Place& pi : places[body])
      for (const Place& pj : places[body])
        if (pi.side >= 0 && pi.row >= pj.row) spin_entries_.push_back({pi.row, pj.row, 0, body, pi.side, pj.side});
  for (int k = 0; k < static_cast<int>(rates.shafts.size()); ++k)
    for (int l = 0; l < static_cast<int>(rates.shafts.size()); ++l)
      if (rates.shafts[k].shaft == rates.shafts[l].shaft && rates.shafts[k].row >= rates.shafts[l].row)
        shaft_entries_.push_back({rates.shafts[k].row, rates.shafts[l].row, 0, k, l});
}

void SchurSolver::add_rate_entries(std::span<const RowJacobian> jacobians, std::span<const Body> bodies,
                                   std::span<const double> compliance, const RateSides& rates,
                                   std::span<const Shaft> shafts) {
  FURROW_ASSERT(compliance.size() == jacobians.size() + rates.count, compliance.size(), jacobians.size());
  double* values = S_.valuePtr();
  for (const SpinEntry& entry : spin_entries_) {
    if (compliance[entry.i] < 0.0 || compliance[entry.j] < 0.0) continue;
    const Vec3& wi = rates.spins[entry.i_side].w;
    const Vec3& wj = entry.j_side >= 0        ? rates.spins[entry.j_side].w
                     : entry.j_side == kSideB ? jacobians[entry.j].w_b
                                              : jacobians[entry.j].w_a;
    values[entry.value] += wi.dot(bodies[entry.body].inertia_inverse_W * wj);
  }
  for (const ShaftEntry& entry : shaft_entries_) {
    if (compliance[entry.i] < 0.0 || compliance[entry.j] < 0.0) continue;
    const ShaftSide &si = rates.shafts[entry.i_side], &sj = rates.shafts[entry.j_side];
    FURROW_ASSERT(in_range(si.shaft, shafts.size()), si.shaft, shafts.size());
    values[entry.value] += si.factor * sj.factor / shafts[si.shaft].inertia;
  }
}

bool SchurSolver::factorize(std::span<const RowJacobian> jacobians, std::span<const Body> bodies,
                            std::span<const double> compliance, const RateSides& rates, std::span<const Shaft> shafts) {
  FURROW_ASSERT(jacobians.size() + rates.count == diagonal_.size(), jacobians.size(), diagonal_.size());
  FURROW_ASSERT(compliance.size() == diagonal_.size(), compliance.size(), diagonal_.size());
  double* values = S_.valuePtr();
  std::fill(values, values + S_.nonZeros(), 0.0);
  for (const Entry& entry : entries_) {
    FURROW_ASSERT(in_range(entry.body, bodies.size()), entry.body, bodies.size());
    if (compliance[entry.i] < 0.0 || compliance[entry.j] < 0.0) continue;
    const RowJacobian &Ji = jacobians[entry.i], &Jj = jacobians[entry.j];
    const Body& body = bodies[entry.body];
    const Vec3 &vi = entry.i_is_b ? Ji.v_b : Ji.v_a, &vj = entry.j_is_b ? Jj.v_b : Jj.v_a;
    const Vec3 &wi = entry.i_is_b ? Ji.w_b : Ji.w_a, &wj = entry.j_is_b ? Jj.w_b : Jj.w_a;
    values[entry.value] += vi.dot(vj) / body.mass + wi.dot(body.inertia_inverse_W * wj);
  }
  add_rate_entries(jacobians, bodies, compliance, rates, shafts);
  double largest = 0.0;
  for (const int index : diagonal_) largest = std::max(largest, values[index]);
  epsilon_ = kRegularization * largest;
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    if (compliance[i] < 0.0)
      values[diagonal_[i]] = 1.0;
    else
      values[diagonal_[i]] += compliance[i] + epsilon_;
  }
  ldlt_.factorize(S_);
  return ldlt_.info() == Eigen::Success;
}

void SchurSolver::multiply(const Eigen::VectorXd& P, Eigen::VectorXd& r) const {
  FURROW_ASSERT(P.size() == S_.rows(), P.size(), S_.rows());
  r.noalias() = S_.selfadjointView<Eigen::Lower>() * P;
  r -= epsilon_ * P;
}

void SchurSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& P) const {
  FURROW_ASSERT(r.size() == S_.rows(), r.size(), S_.rows());
  P = ldlt_.solve(r);
}

}  // namespace furrow::vehicle
