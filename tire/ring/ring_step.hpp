// One step of a ring on the ground: the change Δ of its displacements that minimises
//   ½ Δᵀ K Δ + ½ γ (1·Δ)² + rᵀ Δ   under   g + C Δ ≥ 0                                                         (1)
// with the tangent K and the gradient r of the energy, the air's γ, 1 = (1, …, 1) on u, and the gaps g of segments and
// corners with their slopes C. The contact forces λ ≥ 0 are the multipliers.
//
// Primal–dual active set: for a given set of closed gaps, (1) is a linear system. Then gaps that pull leave the set and
// gaps that penetrate join it, until nothing changes. If sets alternate, only the worst member changes at a time.
#pragma once

#include <array>
#include <vector>

#include "tire/ring/folded_band.hpp"
#include "tire/ring/ring_contact.hpp"

namespace furrow::tire {

/// Closed gaps and their forces, of segments and of the corner gaps in the order of their list.
struct ContactSet {
  std::vector<char> segment, corner;
  std::vector<double> segment_force, corner_force;  // λ, N
};

class RingStep {
 public:
  explicit RingStep(int segments);

  struct Problem {
    const RingTangent& tangent;  // K, γ
    const RingField& gradient;   // r
    const std::vector<SegmentGap>& segments;
    const std::vector<CornerGap>& corners;
    double force_tolerance, gap_tolerance;  // N, m
  };
  /// Solves (1) from the given set, and replaces the set. @returns linear systems solved; 0: no solution was found
  int solve(const Problem& problem, ContactSet& set);
  const RingField& change() const { return change_; }

 private:
  bool solve_closed(const Problem& p, const ContactSet& set);
  void stiffen(const CornerGap& corner, double rho);
  void turn(const Problem& p, const ContactSet& set);
  void fix_block(const ContactSet& set, int d, int j, int k);
  void fill_lanes(const Problem& p, const ContactSet& set);
  void fill_border(const Problem& p, const ContactSet& set);
  void eliminate_border();
  void collect();
  void forces(const Problem& p, ContactSet& set);
  int update(const Problem& p, ContactSet& set, bool one);
  std::size_t at(int segment) const { return static_cast<std::size_t>(FoldedBand::kLanes) * band_.place(segment); }
  double* lane(int column) {
    return &lanes_[(column / FoldedBand::kLanes) * band_.entries() + column % FoldedBand::kLanes];
  }
  int after(int segment, int places) const { return (segment + places) % n_; }
  double on_gas(const ContactSet& set, int column);
  double on_corner(const Problem& p, int b, int column);

  FoldedBand band_;
  int n_;
  RingField change_, right_;
  RingTangent turned_;
  std::vector<double> along_u_, along_v_;     // unit vector of a closed segment's gap; 1, 0 of others
  std::vector<double> move_;                  // prescribed along it, m
  std::vector<int> closed_;                   // corner gaps
  std::vector<std::array<double, 6>> slope_;  // of these, in turned axes, free part
  std::vector<double> known_;                 // prescribed change of these, m
  std::vector<double> lanes_, border_, border_right_;
  double gas_known_ = 0.0;
};

}  // namespace furrow::tire
