// Contact of a planar tire with rigid ground: the tire's outer nodes in the ground, and
// the ground's corners in the tire.
//
// A node at a depth h below the ground's nearest side gets the force c h along the way out. A corner at a depth h
// behind the nearest side of the tire pushes that side away, its force shared by the side's two nodes as it lies
// between them; its mass m is that of the point of the side, 1/m = (1 − s)²/m_a + s²/m_b. In motion, with a step Δt,
//   F = c h,   d = ½ F/m Δt² + v_n Δt,   F ← F h/d where d > h,   F_f = min(f F, |v_t| m/Δt),                   (1)
// v_n > 0 separating: a force pushes no farther than out of the ground, and friction against the sliding velocity v_t
// no more than to rest. At rest the force is that of the energy Σ ½ c h².
#pragma once

#include <vector>

#include "tire/planar/planar_ground.hpp"
#include "tire/planar/planar_motion.hpp"

namespace furrow::tire {

/// F of (1), N. @param separation v_n, m/s. @pre depth ≥ 0; mass, step > 0
double planar_normal_force(double stiffness, double depth, double separation, double mass, double step);
/// F_f of (1), N, not negative.
double planar_friction_force(double friction, double normal, double sliding, double mass, double step);

/// One place where tire and ground touch: on a side from node a to node b, at `share` from a; b = −1: on the node a.
struct PlanarTouch {
  int a = 0, b = -1;
  double share = 0.0;
  double depth = 0.0;                  // m
  double push_x = 0.0, push_z = 0.0;   // unit vector of the force on the tire
  double force = 0.0, friction = 0.0;  // N; friction along (push_z, −push_x)
};

struct PlanarContactLaw {
  double stiffness = 0.0;  // c, N/m
  double friction = 0.0;   // f
};

class PlanarContact {
 public:
  PlanarContact(const PlanarMesh& mesh, PlanarGround ground, const PlanarContactLaw& law);

  const PlanarGround& ground() const { return ground_; }
  const PlanarContactLaw& law() const { return law_; }

  /// Finds what touches and adds (1).
  void load(const PlanarState& state, const std::vector<double>& mass, double step, PlanarField& force);
  /// Finds what touches at rest, with its forces; without friction.
  void find(const PlanarField& x);
  double energy() const;  // of what was found at rest, J
  /// Of the last search: nodes along the edge of the tire, then corners.
  const std::vector<PlanarTouch>& touches() const { return touches_; }
  /// On the tire, N.
  double force_x() const;
  double force_z() const;

 private:
  void find_nodes(const PlanarField& x);
  void find_corners(const PlanarField& x);

  std::vector<int> outer_;
  double reach_;  // how deep a corner may lie in the tire, m
  PlanarGround ground_;
  PlanarContactLaw law_;
  std::vector<PlanarTouch> touches_;
};

}  // namespace furrow::tire
