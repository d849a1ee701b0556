// The shortest vector that moves a sphere out of all walls that it overlaps. Like facets.hpp, for the processor and for
// a GPU.
//
// Its multipliers λ ≥ 0, D = Σ λ_i n_i with D·n_i ≥ δ_i, solve the complementarity problem
//
//   w = G λ − δ ≥ 0,  λ ≥ 0,  λ·w = 0,     G_ij = max(0, n_i·n_j) + ε [i = j],  ε = 1e-12.
//
// Walls that face each other (n_i·n_j < 0) do not affect each other, so λ_i ≤ δ_i always. ε makes λ unique when
// normals are linearly dependent. Active-set method of [Lawson & Hanson, Solving Least Squares Problems, 1974, ch. 23],
// exact while G is definite: always if no two walls face each other. Otherwise a wall that the method cannot place is
// left out.
#pragma once

#include <cstdint>

#include "protocol/core/triple.hpp"

namespace furrow::terrain {

inline constexpr int kMaxWalls = 16;  // that push_out takes

/// The walls that carry a share, with G restricted to them.
struct ActiveWalls {
  static constexpr int kMost = 6;
  static constexpr double kRegularisation = 1e-12;  // ε
  using Vector = simd::Triple<double>;

  const Vector* normal;
  const double* overlap;
  int index[kMost];
  double lambda[kMost];
  int size;

  FURROW_HD double coupling(int i, int j) const { return simd::larger(dot(normal[i], normal[j]), 0.0); }
  FURROW_HD bool holds(int i) const {
    for (int k = 0; k < size; ++k)
      if (index[k] == i) return true;
    return false;
  }
  FURROW_HD void drop(int k) {
    for (int i = k; i + 1 < size; ++i) {
      index[i] = index[i + 1];
      lambda[i] = lambda[i + 1];
    }
    --size;
  }
  /// Solves G_AA x = δ_A by elimination; G_AA is small and regularised.
  FURROW_HD void solve(double* x) const {
    double g[kMost][kMost + 1];
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) g[i][j] = i == j ? 1.0 + kRegularisation : coupling(index[i], index[j]);
      g[i][size] = overlap[index[i]];
    }
    for (int k = 0; k < size; ++k) {
      // G can lose definiteness only because it is cut off at zero; this guard then keeps the result finite.
      if (g[k][k] < kRegularisation && g[k][k] > -kRegularisation) g[k][k] = kRegularisation;
      for (int i = k + 1; i < size; ++i) {
        const double factor = g[i][k] / g[k][k];
        for (int j = k; j <= size; ++j) g[i][j] -= factor * g[k][j];
      }
    }
    for (int k = size - 1; k >= 0; --k) {
      double sum = g[k][size];
      for (int j = k + 1; j < size; ++j) sum -= g[k][j] * x[j];
      x[k] = sum / g[k][k];
    }
  }
  /// Moves the active λ to their solution, dropping walls that would turn negative on the way.
  FURROW_HD void settle() {
    while (size > 0) {
      double x[kMost];
      solve(x);
      double way = 1.0;
      int first_out = -1;
      for (int k = 0; k < size; ++k) {
        if (x[k] > 0.0) continue;
        const double share = lambda[k] / (lambda[k] - x[k] + 1e-300);
        if (first_out < 0 || share < way) {
          way = share;
          first_out = k;
        }
      }
      for (int k = 0; k < size; ++k) lambda[k] = first_out < 0 ? x[k] : lambda[k] + way * (x[k] - lambda[k]);
      if (first_out < 0) return;
      drop(first_out);
    }
  }
};

/// Sets λ of n walls, whose overlaps may have any order. Returns the number of λ_i > 0.
/// @pre 0 ≤ n ≤ kMaxWalls, all overlaps > 0
FURROW_HD inline int push_out(const simd::Triple<double>* normal, const double* overlap, int n, double* lambda) {
  constexpr double kTolerance = 1e-11;  // of the deepest overlap
  static_assert(kMaxWalls <= 32);
  for (int i = 0; i < n; ++i) lambda[i] = 0.0;
  if (n == 0) return 0;
  int deepest = 0;
  for (int i = 1; i < n; ++i)
    if (overlap[i] > overlap[deepest]) deepest = i;

  std::uint32_t left_out = 0;
  ActiveWalls active{normal, overlap, {deepest}, {overlap[deepest] / (1.0 + ActiveWalls::kRegularisation)}, 1};
  for (int round = 0; round < 4 * ActiveWalls::kMost && active.size < ActiveWalls::kMost; ++round) {
    double worst = kTolerance * overlap[deepest];
    int next = -1;
    for (int i = 0; i < n; ++i) {
      if (active.holds(i) || (left_out >> i & 1U)) continue;
      double lack = overlap[i];
      for (int k = 0; k < active.size; ++k) lack -= active.lambda[k] * active.coupling(i, active.index[k]);
      if (lack > worst) {
        worst = lack;
        next = i;
      }
    }
    if (next < 0) break;
    active.index[active.size] = next;
    active.lambda[active.size] = 0.0;
    ++active.size;
    active.settle();
    if (!active.holds(next)) left_out |= 1U << next;
  }
  int count = 0;
  for (int k = 0; k < active.size; ++k) {
    const int i = active.index[k];
    lambda[i] = simd::smaller(active.lambda[k] * (1.0 + ActiveWalls::kRegularisation), overlap[i]);
    if (lambda[i] > 0.0) ++count;
  }
  return count;
}

/// Overlap that the contact law gets for each wall. λ is not unique where more than three walls meet in a shallow
/// pit, and a nonlinear law would make its choice noticeable. So walls of nearly one direction share the depth of the
/// deepest of them:  δ̂_i = max_j [δ_i + w(n_i·n_j) max(0, δ_j − δ_i)],  w = 1 up to 45° apart, 0 from 73°.
FURROW_HD inline void share_depth(const simd::Triple<double>* normal, const double* overlap, int n, double* shared) {
  constexpr double kFull = 0.7, kNone = 0.3;  // cosines between which w falls from 1 to 0
  for (int i = 0; i < n; ++i) {
    shared[i] = overlap[i];
    for (int j = 0; j < n; ++j) {
      if (overlap[j] <= overlap[i]) continue;
      const double w = simd::smaller(simd::larger((dot(normal[i], normal[j]) - kNone) / (kFull - kNone), 0.0), 1.0);
      shared[i] = simd::larger(shared[i], overlap[i] + w * (overlap[j] - overlap[i]));
    }
  }
}

}  // namespace furrow::terrain
