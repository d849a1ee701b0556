// Factor and solution of a symmetric cyclic system of 2 × 2 blocks, each coupled with two neighbours on both sides, as
// a band. The ring is folded flat: with segments in the order 0, N − 1, 1, N − 2, 2, …, neighbours of second order are
// at most four places apart. Nine entries lie below each diagonal entry, and there is no fill-in beyond them.
//
// Right-hand sides are solved together, kLanes at a time, interleaved. Together they cost about as much as one.
#pragma once

#include <cstddef>
#include <vector>

#include "tire/ring/ring_mechanics.hpp"

namespace furrow::tire {

class FoldedBand {
 public:
  static constexpr int kLanes = 4;

  explicit FoldedBand(int segments);

  /// Place of u of a segment in a right-hand side; v is the next one.
  int place(int segment) const { return place_[segment]; }
  int unknowns() const { return unknowns_; }

  /// L D Lᵀ of the blocks. @returns whether all pivots are positive
  bool factorize(const RingTangent& blocks);
  /// Entries of right-hand sides, including those behind the last unknown, which stay zero.
  std::size_t entries() const { return static_cast<std::size_t>(kLanes) * (unknowns_ + kBelow); }
  /// Solves in place. @pre factorized; x has entries() entries, lane by lane of each unknown, the last ones zero
  void solve(double* x) const;

 private:
  static constexpr int kBelow = 9, kStride = 10;

  int unknowns_;
  std::vector<int> place_;
  std::vector<double> band_;     // column by column: the diagonal entry, then those below it
  std::vector<double> inverse_;  // of the pivots
};

}  // namespace furrow::tire
