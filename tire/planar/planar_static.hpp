// A planar wheel at rest on rigid ground without friction. Its centre node is held in place; a couple holds its disc's
// rim against turning.
//
// Newton's method with a line search finds the minimum of Π = elastic energy + Σ ½ c h² + ½ k θ², with the mean turn θ
// of the rim. If the tangent is not positive definite, a share of its diagonal at rest is added. The centre moves to a
// new place in parts small enough for convergence.
#pragma once

#include <memory>

#include "tire/planar/planar_contact.hpp"
#include "tire/planar/planar_params.hpp"
#include "tire/planar/planar_tangent.hpp"
#include "tire/press/press_obstacle.hpp"

namespace furrow::tire {

struct PlanarReport {
  bool converged = false;
  int steps = 0;          // of Newton's method
  int indefinite = 0;     // tangents that were not positive definite
  double residual = 0.0;  // largest free force, N
};

class PlanarStatic {
 public:
  PlanarStatic(const PlanarParams& params, PlanarGround ground);
  ~PlanarStatic();
  PlanarStatic(const PlanarStatic&) = delete;
  PlanarStatic& operator=(const PlanarStatic&) = delete;

  /// Moves the centre from its present place to this one. The wheel starts undeformed, just above the ground, at x = 0.
  PlanarReport move_to(PlanarPoint centre);

  const PlanarMesh& mesh() const { return mesh_; }
  const PlanarElements& elements() const { return elements_; }
  const PlanarField& shape() const { return x_; }
  const PlanarContact& contact() const { return contact_; }
  double force() const { return contact_.force_z(); }  // of the ground on the tire, upwards, N
  double couple() const;                               // on the rim that holds it, about +y, N m
  Wrench rim() const;  // of the tire on the rim about the centre, from the ground's forces
  /// Stiffness along x and z against a ground to which the tire sticks wherever it touches; sideways the tire is rigid.
  /// @param tangential tangential stiffness as a share of the contact's stiffness; 0: it slides
  GroundStiffness ground_stiffness(double tangential = 1.0);

 private:
  struct Linear;
  PlanarReport solve();
  double potential(const PlanarField& x);
  double gradient(const PlanarField& x);  // into right_, with its sign changed; largest component
  void assemble(double tangential = 0.0);
  PlanarMatrix touch_stiffness(const PlanarTouch& touch, double tangential) const;
  bool factorize(double share);
  bool descend(double& potential, double& residual);
  double turn(const PlanarField& x) const;

  PlanarMesh mesh_;
  PlanarElements elements_;
  PlanarContact contact_;
  PlanarPoint centre_;
  PlanarField x_, still_, force_, trial_;
  double spring_ = 0.0, inertia_ = 0.0;  // k, N m; Σr² of the rim, m²
  std::unique_ptr<Linear> linear_;
};

}  // namespace furrow::tire
