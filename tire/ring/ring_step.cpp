// For a set of closed gaps, segments' gaps are eliminated and corners' gaps border the system,
//   K Δ + γ 1 (1·Δ) − Cᵀ μ = −r,   C Δ = −g.
// In axes turned so that the first coordinate of a closed segment lies along ∂g, that coordinate is known. Let f mark
// the others, d the known ones and τ = γ (1·Δ):
//   Δ_f = X₀ − X₁ τ + X_c μ,   K_ff X₀ = −r_f − K_fd d,   K_ff X₁ = 1_f,   K_ff X_c = C_fᵀ,
//   τ/γ + 1·X₁ τ − 1·X_c μ = 1·X₀ + 1·d,   −C X₁ τ + C X_c μ = −g − C d − C X₀.
#include "tire/ring/ring_step.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr int kTogether = 12;  // systems before a set changes by one member at a time
constexpr int kMostSystems = 150;
constexpr double kDependent = 1e-10;  // share of a corner's own compliance below which others already hold it

}  // namespace

RingStep::RingStep(int segments) : band_(segments), n_(segments) {
  const std::size_t n = segments, corners = RingContact::kMostCornerGaps;
  for (RingField* field : {&change_, &right_}) field->u.resize(n), field->v.resize(n);
  for (auto* blocks : {&turned_.uu, &turned_.uv, &turned_.vu, &turned_.vv})
    for (std::vector<double>& one : *blocks) one.resize(n);
  along_u_.resize(n), along_v_.resize(n), move_.resize(n);
  closed_.reserve(corners), slope_.resize(corners), known_.resize(corners);
  lanes_.resize((2 + corners + FoldedBand::kLanes - 1) / FoldedBand::kLanes * band_.entries());
  border_.resize((1 + corners) * (1 + corners)), border_right_.resize(1 + corners);
}

int RingStep::solve(const Problem& p, ContactSet& set) {
  FURROW_ASSERT(set.corner.size() == p.corners.size(), set.corner.size(), p.corners.size());
  for (int i = 1; i <= kMostSystems; ++i) {
    if (!solve_closed(p, set)) return 0;
    forces(p, set);
    if (update(p, set, i >= kTogether) == 0) return i;
  }
  return 0;
}

/// @returns whether the system is positive definite
bool RingStep::solve_closed(const Problem& p, const ContactSet& set) {
  turned_ = p.tangent;
  right_.u = p.gradient.u, right_.v = p.gradient.v;
  closed_.clear();
  for (int k = 0; k < static_cast<int>(p.corners.size()); ++k)
    if (set.corner[k]) closed_.push_back(k), stiffen(p.corners[k], p.tangent.uu[0][0]);
  turn(p, set);
  if (!band_.factorize(turned_)) return false;
  fill_lanes(p, set);
  const int columns = 2 + static_cast<int>(closed_.size());
  for (int c = 0; c < columns; c += FoldedBand::kLanes) band_.solve(lane(c));
  fill_border(p, set);
  eliminate_border();
  collect();
  return std::isfinite(change_.u[0]);
}

/// Adds ½ρ (C Δ + g)², which is zero in the solution: the tangent only has to be positive definite with the gap closed.
void RingStep::stiffen(const CornerGap& corner, double rho) {
  std::array<double, 36> square;
  for (int i = 0; i < 6; ++i)
    for (int o = 0; o < 6; ++o) square[6 * i + o] = corner.slope[i] * corner.slope[o];
  add_local(turned_, corner.first, square, rho);
  for (int side = 0; side < 3; ++side) {
    const int j = after(corner.first, side);
    right_.u[j] += rho * corner.gap * corner.slope[2 * side];
    right_.v[j] += rho * corner.gap * corner.slope[2 * side + 1];
  }
}

/// Turns the axes of closed segments along their gaps and eliminates these coordinates.
void RingStep::turn(const Problem& p, const ContactSet& set) {
  for (int j = 0; j < n_; ++j) {
    along_u_[j] = 1.0, along_v_[j] = move_[j] = 0.0;
    if (set.segment[j]) {
      const SegmentGap& gap = p.segments[j];
      const double length = std::sqrt(gap.du * gap.du + gap.dv * gap.dv);
      along_u_[j] = gap.du / length, along_v_[j] = gap.dv / length, move_[j] = -gap.gap / length;
    }
    const double u = right_.u[j], v = right_.v[j];
    right_.u[j] = -(along_u_[j] * u + along_v_[j] * v);
    right_.v[j] = along_v_[j] * u - along_u_[j] * v;
  }
  for (int d = 0; d < 3; ++d)
    for (int j = 0; j < n_; ++j) {
      const int k = j + d < n_ ? j + d : j + d - n_;
      if (set.segment[j] || set.segment[k]) fix_block(set, d, j, k);
    }
  for (int j = 0; j < n_; ++j)
    if (set.segment[j]) right_.u[j] = turned_.uu[0][j] * move_[j];
}

void RingStep::fix_block(const ContactSet& set, int d, int j, int k) {
  double &uu = turned_.uu[d][j], &uv = turned_.uv[d][j], &vu = turned_.vu[d][j], &vv = turned_.vv[d][j];
  const double cj = along_u_[j], sj = along_v_[j], ck = along_u_[k], sk = along_v_[k];
  const double ua = uu * ck + uv * sk, ub = uv * ck - uu * sk, va = vu * ck + vv * sk, vb = vv * ck - vu * sk;
  uu = cj * ua + sj * va, uv = cj * ub + sj * vb, vu = cj * va - sj * ua, vv = cj * vb - sj * ub;
  if (d == 0) {
    right_.v[j] -= vu * move_[j];
    uv = vu = 0.0;
    return;
  }
  if (set.segment[j]) right_.u[k] -= uu * move_[j], right_.v[k] -= uv * move_[j];
  if (set.segment[k]) right_.u[j] -= uu * move_[k], right_.v[j] -= vu * move_[k];
  if (set.segment[j]) uu = uv = 0.0;
  if (set.segment[k]) uu = vu = 0.0;
}

void RingStep::fill_lanes(const Problem& p, const ContactSet& set) {
  const int columns = 2 + static_cast<int>(closed_.size());
  for (int c = 0; c < columns; c += FoldedBand::kLanes) std::fill_n(lane(c), band_.entries(), 0.0);
  double *const load = lane(0), *const gas = lane(1);
  gas_known_ = 0.0;
  for (int j = 0; j < n_; ++j) {
    load[at(j)] = right_.u[j], load[at(j) + FoldedBand::kLanes] = right_.v[j];
    gas[at(j)] = set.segment[j] ? 0.0 : 1.0;
    gas[at(j) + FoldedBand::kLanes] = -along_v_[j];
    if (set.segment[j]) gas_known_ += along_u_[j] * move_[j];
  }
  for (std::size_t b = 0; b < closed_.size(); ++b) {
    const CornerGap& corner = p.corners[closed_[b]];
    double* const column = lane(2 + static_cast<int>(b));
    known_[b] = 0.0;
    for (int side = 0; side < 3; ++side) {
      const int j = after(corner.first, side);
      const double u = corner.slope[2 * side], v = corner.slope[2 * side + 1];
      double along = along_u_[j] * u + along_v_[j] * v;
      const double across = along_u_[j] * v - along_v_[j] * u;
      if (set.segment[j]) known_[b] += along * move_[j], along = 0.0;
      slope_[b][2 * side] = along, slope_[b][2 * side + 1] = across;
      column[at(j)] = along, column[at(j) + FoldedBand::kLanes] = across;
    }
  }
}

double RingStep::on_gas(const ContactSet& set, int column) {
  const double* const x = lane(column);
  double sum = 0.0;
  for (int j = 0; j < n_; ++j) sum += (set.segment[j] ? 0.0 : x[at(j)]) - along_v_[j] * x[at(j) + FoldedBand::kLanes];
  return sum;
}

double RingStep::on_corner(const Problem& p, int b, int column) {
  const double* const x = lane(column);
  double sum = 0.0;
  for (int side = 0; side < 3; ++side) {
    const int j = after(p.corners[closed_[b]].first, side);
    sum += slope_[b][2 * side] * x[at(j)] + slope_[b][2 * side + 1] * x[at(j) + FoldedBand::kLanes];
  }
  return sum;
}

void RingStep::fill_border(const Problem& p, const ContactSet& set) {
  const int m = 1 + static_cast<int>(closed_.size());
  double* const a = border_.data();
  a[0] = 1.0 / p.tangent.gas + on_gas(set, 1);
  border_right_[0] = on_gas(set, 0) + gas_known_;
  for (int b = 1; b < m; ++b) {
    a[b] = -on_gas(set, 1 + b), a[b * m] = -on_corner(p, b - 1, 1);
    for (int c = 1; c < m; ++c) a[b * m + c] = on_corner(p, b - 1, 1 + c);
    border_right_[b] = -p.corners[closed_[b - 1]].gap - known_[b - 1] - on_corner(p, b - 1, 0);
  }
}

/// Computes τ and μ in border_right_. The system is symmetric and positive definite except for corners that others
/// already hold; their force stays zero.
void RingStep::eliminate_border() {
  const int m = 1 + static_cast<int>(closed_.size());
  double* const a = border_.data();
  const auto drop = [&](int i) {
    for (int c = 0; c < m; ++c) a[i * m + c] = a[c * m + i] = 0.0;
    a[i * m + i] = 1.0, border_right_[i] = 0.0;
  };
  for (int i = 0; i < m; ++i) {
    if (i > 0) {
      double own = 0.0;
      for (const double s : slope_[i - 1]) own += s * s;
      if (!(a[i * m + i] > kDependent * own / turned_.vv[0][0])) drop(i);
    }
    for (int r = i + 1; r < m; ++r) {
      const double factor = a[r * m + i] / a[i * m + i];
      for (int c = i; c < m; ++c) a[r * m + c] -= factor * a[i * m + c];
      border_right_[r] -= factor * border_right_[i];
    }
  }
  for (int i = m - 1; i >= 0; --i) {
    for (int c = i + 1; c < m; ++c) border_right_[i] -= a[i * m + c] * border_right_[c];
    border_right_[i] /= a[i * m + i];
  }
}

void RingStep::collect() {
  for (int j = 0; j < n_; ++j) {
    double along = 0.0, across = 0.0;
    const auto add = [&](int column, double share) {
      along += share * lane(column)[at(j)], across += share * lane(column)[at(j) + FoldedBand::kLanes];
    };
    add(0, 1.0), add(1, -border_right_[0]);
    for (std::size_t b = 0; b < closed_.size(); ++b) add(2 + static_cast<int>(b), border_right_[b + 1]);
    change_.u[j] = along_u_[j] * along - along_v_[j] * across;
    change_.v[j] = along_v_[j] * along + along_u_[j] * across;
  }
}

/// λ = ∂g·(r + K Δ + γ 1 (1·Δ) − Cᵀ μ) / |∂g|².
void RingStep::forces(const Problem& p, ContactSet& set) {
  const RingTangent& k = p.tangent;
  std::fill(set.corner_force.begin(), set.corner_force.end(), 0.0);
  for (std::size_t b = 0; b < closed_.size(); ++b) set.corner_force[closed_[b]] = border_right_[b + 1];
  double sum = 0.0;
  for (const double u : change_.u) sum += u;
  for (int j = 0; j < n_; ++j) {
    set.segment_force[j] = 0.0;
    if (!set.segment[j]) continue;
    std::array<double, 2> left = tangent_row(k, change_, sum, j);
    left[0] += p.gradient.u[j], left[1] += p.gradient.v[j];
    for (const int b : closed_)
      for (int side = 0; side < 3; ++side)
        if (after(p.corners[b].first, side) == j)
          for (int i = 0; i < 2; ++i) left[i] -= set.corner_force[b] * p.corners[b].slope[2 * side + i];
    const SegmentGap& gap = p.segments[j];
    set.segment_force[j] = (left[0] * gap.du + left[1] * gap.dv) / (gap.du * gap.du + gap.dv * gap.dv);
  }
}

/// Changes the set. @returns the number of members that leave or join it; with `one` only the worst changes
int RingStep::update(const Problem& p, ContactSet& set, bool one) {
  int changes = 0;
  double worst_by = 0.0;
  char* worst = nullptr;
  const auto look = [&](char& on, double force, double gap) {
    const double by = on ? -force / p.force_tolerance : -gap / p.gap_tolerance;
    if (!(by > 1.0)) return;
    ++changes;
    if (!one) on = on ? 0 : 1;
    if (by > worst_by) worst_by = by, worst = &on;
  };
  for (int j = 0; j < n_; ++j) {
    const SegmentGap& s = p.segments[j];
    look(set.segment[j], set.segment_force[j], s.gap + s.du * change_.u[j] + s.dv * change_.v[j]);
  }
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    const CornerGap& c = p.corners[k];
    double gap = c.gap;
    for (int side = 0; side < 3; ++side) {
      const int j = after(c.first, side);
      gap += c.slope[2 * side] * change_.u[j] + c.slope[2 * side + 1] * change_.v[j];
    }
    look(set.corner[k], set.corner_force[k], gap);
  }
  if (one && worst != nullptr) *worst = *worst ? 0 : 1;
  return changes;
}

}  // namespace furrow::tire
