// Gaps between a flexible ring and the ground, and their derivatives.
//
// Angles θ are measured from straight down towards +x. With the displacement d_j = u e_r + v e_t of a segment, e_r =
// (sin θ_j, −cos θ_j), e_t = (cos θ_j, sin θ_j), segments are at R e_r + d_j, seen from the axle, and between them the
// belt is a smooth curve, in θ = θ_j + sφ, |s| ≤ ½,
//   (x, z) = R (sin θ, −cos θ) + ½ (½ − s)² d_{j−1} + (¾ − s²) d_j + ½ (½ + s)² d_{j+1}.                       (1)
// Gaps are g ≥ 0 where nothing penetrates. With the kinematics
//   exact   a segment's gap is z − h(x), a corner's is that of (1), z − z_c where x = x_c;                     (2)
//   radial  v is left out: a segment's gap is ρ(θ) − R − u, ρ the ground's distance along its ray, and a corner's
//           is the same at its own angle, with u as in (1).                                                  (3)
// A contact force λ ≥ 0 acts as λ ∂g/∂q. It is frictionless in (2). In (3) it is radial, so on inclined rays it has a
// part along the ground that no law of friction bounds. This is a consequence of leaving out v.
//
// Where the belt is less curved than the circle, (1) lies on or below the segments. So when a segment passes over a
// corner, the corner already carries the belt, and the force does not jump. (1) differs from the segments by at most
// the curvature times (Rφ)²/8.
#pragma once

#include <array>
#include <vector>

#include "tire/ring/ring_ground.hpp"
#include "tire/ring/ring_mechanics.hpp"

namespace furrow::tire {

/// Position of the axle over the ground, m.
struct AxlePlace {
  double x = 0.0, z = 0.0;
};

/// A segment over a face.
struct SegmentGap {
  double gap = 0.0;                   // m; infinite if the segment is over no face
  double du = 0.0, dv = 0.0;          // ∂g/∂u, ∂g/∂v
  double push_x = 0.0, push_z = 0.0;  // force on the belt per λ, forward and up
};

/// A corner under the belt: its gap and derivatives in terms of three neighbouring segments.
struct CornerGap {
  int corner = -1, first = -1;    // first: of the three segments
  double gap = 0.0;               // m
  std::array<double, 6> slope{};  // ∂g/∂(u, v) of the three
  std::array<double, 36> bend{};  // ∂²g, 1/m
  std::array<double, 3> share{};  // of the three in the belt's displacement there, (1)
  double push_x = 0.0, push_z = 0.0;
};

class RingContact {
 public:
  static constexpr int kMostCornerGaps = 254;

  RingContact(const RingMechanics& ring, const RingGround& ground);

  const RingGround& ground() const { return ground_; }
  int segments() const { return static_cast<int>(sine_.size()); }

  /// Sets the axle's position; the ρ of (3) depend on nothing else.
  void place(const AxlePlace& axle);
  SegmentGap segment(const RingField& q, int j) const;
  /// Appends the gaps of all corners near the belt. @returns whether there are at most kMostCornerGaps
  bool corners(const RingField& q, std::vector<CornerGap>& out) const;
  /// Position of the segment relative to the axle, m, for either kinematics.
  GroundPoint position(const RingField& q, int j) const;
  double sine(int j) const { return sine_[j]; }
  double cosine(int j) const { return cosine_[j]; }

 private:
  struct Belt;  // (1) and its derivatives
  void exact_corner(const RingField& q, int k, std::vector<CornerGap>& out) const;
  void radial_corner(const RingField& q, int k, std::vector<CornerGap>& out) const;
  bool reaches_down(int j) const { return cosine_[j] > kSteepest; }
  int wrapped(int turn) const { return turn < 0 ? turn + segments() : turn; }
  int after(int j, int places) const { return (j + places) % segments(); }

  static constexpr double kSteepest = 0.1;  // cosine of the angle beyond which there is no contact

  RingGround ground_;
  RingKinematics kinematics_;
  double radius_, phi_;
  std::vector<double> sine_, cosine_;
  AxlePlace axle_;
  std::vector<double> ray_;         // ρ of (3)
  std::vector<double> corner_ray_;  // ρ of corners; infinite: hidden
};

}  // namespace furrow::tire
