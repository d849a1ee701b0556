// Quasi-static equilibrium of a flexible ring on rigid ground: the minimum of Π(q) (ring_mechanics.hpp) under g(q) ≥ 0
// (ring_contact.hpp). With the contact forces λ, the conditions
//   ∂Π − Σ λ ∂g = 0,   g ≥ 0,   λ ≥ 0,   λ g = 0                                                              (1)
// are solved by Newton's method. Each step is the minimum of the second-order expansion under the linearised gaps; the
// contact set is found with it (ring_step.hpp). The tangent is exact, so steps converge quadratically once the set is
// right. Iterations allocate no memory.
//
// The force on the spindle is the sidewall's force on the rim. It equals the sum of the contact forces to round-off,
// since belt and air do not resist a translation. With exact kinematics it is also −∂Π/∂z of the axle.
#pragma once

#include <array>
#include <vector>

#include "tire/ring/ring_contact.hpp"
#include "tire/ring/ring_mechanics.hpp"
#include "tire/ring/ring_step.hpp"

namespace furrow::tire {

struct RingReport {
  static constexpr int kMostSteps = 40;

  bool converged = false;
  bool crowded = false;  // more corners near the belt than RingContact::kMostCornerGaps
  int steps = 0;
  int systems = 0;                                 // linear systems solved
  double residual = 0.0;                           // largest free force, N
  double penetration = 0.0;                        // largest −g; for closed gaps |g|, m
  double pull = 0.0;                               // largest −λ, N
  std::array<double, kMostSteps + 1> residuals{};  // before each step, N
  std::array<bool, kMostSteps + 1> same_set{};     // whether the step kept the contact set
};

class RingSolver {
 public:
  /// @pre as for RingMechanics
  RingSolver(const RingParams& params, const RingGround& ground);

  const RingMechanics& ring() const { return ring_; }
  const RingContact& contact() const { return contact_; }
  /// Finds the equilibrium at this position of the axle, starting from the present state.
  RingReport solve(const AxlePlace& axle);
  /// Returns to a state that was found before; its corners are found again. @pre it has as many segments
  void restart(const RingField& state, const std::vector<char>& closed_segments);

  const RingField& state() const { return q_; }
  /// Contact forces and gaps at the last position of the axle; only of corners under the belt.
  const ContactSet& contacts() const { return set_; }
  const std::vector<SegmentGap>& segment_gaps() const { return gaps_; }
  const std::vector<CornerGap>& corner_gaps() const { return corners_; }
  RingForce ground_force() const;
  RingForce spindle_force() const { return ring_.spindle(q_); }

 private:
  int step(double force_tolerance, double gap_tolerance);
  bool evaluate();
  bool carry_corners();
  double free_residual();
  void judge(RingReport& report) const;
  void add_bends();

  RingMechanics ring_;
  RingContact contact_;
  RingStep step_;
  int n_;
  RingField q_, gradient_, rest_;
  std::vector<SegmentGap> gaps_;
  std::vector<CornerGap> corners_, corners_before_;
  ContactSet set_, set_before_;
  RingTangent tangent_;
};

}  // namespace furrow::tire
