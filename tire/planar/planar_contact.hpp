// Contact of a planar tire at rest with rigid ground, without friction: the tire's outer nodes touch the ground, and
// the ground's corners touch the tire.
//
// A node at a depth h below the ground's nearest side gets the force c h towards that side. A corner at a depth h
// behind the nearest side of the tire pushes that side away; its position between the side's two nodes divides the
// force between them. The energy of these forces is Σ ½ c h².
#pragma once

#include <vector>

#include "tire/planar/planar_ground.hpp"
#include "tire/planar/planar_mesh.hpp"

namespace furrow::tire {

/// One place where tire and ground touch: on a side from node a to node b, at `share` from a; b = −1: on the node a.
struct PlanarTouch {
  int a = 0, b = -1;
  double share = 0.0;
  double depth = 0.0;                  // m
  double push_x = 0.0, push_z = 0.0;   // unit vector of the force on the tire
  double force = 0.0, friction = 0.0;  // N; friction along (push_z, −push_x)
  double across = 0.0;                 // friction along the normal of the plane, y, N

  int other() const { return b < 0 ? a : b; }
  double force_x() const { return force * push_x + friction * push_z; }  // on the tire, N
  double force_z() const { return force * push_z - friction * push_x; }
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

  /// Finds all touches, with their forces at rest and without friction.
  void find(const PlanarField& x);
  double energy() const;  // of the touches at rest, J
  /// Touches of the last search: nodes along the edge of the tire, then corners.
  const std::vector<PlanarTouch>& touches() const { return touches_; }
  double force_z() const;  // on the tire, N

 protected:
  std::vector<PlanarTouch> touches_;

 private:
  void find_nodes(const PlanarField& x);
  void find_corners(const PlanarField& x);

  std::vector<int> outer_;
  double reach_;  // how deep a corner may lie in the tire, m
  PlanarGround ground_;
  PlanarContactLaw law_;
};

}  // namespace furrow::tire
