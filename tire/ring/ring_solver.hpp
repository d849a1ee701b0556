// Quasi-static equilibrium of a flexible ring on rigid ground: the minimum of Π(q) (ring_mechanics.hpp) under g(q) ≥ 0
// (ring_contact.hpp). With the contact forces λ, the conditions
//   ∂Π − Σ λ ∂g = 0,   g ≥ 0,   λ ≥ 0,   λ g = 0                                                              (1)
// are solved by Newton's method: each step is the minimum of the second-order expansion under the linearised gaps, its
// contact set found as part of it (ring_step.hpp). The tangent is exact, so steps converge quadratically as soon as the
// set is right. Nothing is allocated in an iteration.
//
// Force on the spindle: what the sidewall exerts on the rim. It equals the sum of the contact forces to round-off,
// since belt and air are free under a translation; with exact kinematics it is also −∂Π/∂z of the axle.
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
  double penetration = 0.0;                        // largest −g, m
  double pull = 0.0;                               // largest −λ, N
  std::array<double, kMostSteps + 1> residuals{};  // before each step, N
  std::array<bool, kMostSteps + 1> same_set{};     // that step left the contact set as it was
};

class RingSolver {
 public:
  /// @pre as of RingMechanics
  RingSolver(const RingParams& params, const RingGround& ground);

  const RingMechanics& ring() const { return ring_; }
  const RingContact& contact() const { return contact_; }
  /// Equilibrium with the axle in this place, from the present state.
  RingReport solve(const AxlePlace& axle);
  /// Back to a state that was found before; its corners are found again. @pre of as many segments
  void restart(const RingField& state, const std::vector<char>& closed_segments);

  const RingField& state() const { return q_; }
  /// Contact forces and gaps at the last place; of corners those that are under the belt.
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
