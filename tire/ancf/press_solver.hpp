// Static pressing of an inflated ring of shell elements with fixed beads on a frictionless obstacle z = H(x). The
// obstacle is given in the ground's axes (press_obstacle.hpp); their z is n in the wheel's axes.
//
// Equilibrium is a minimum of the potential of elastic, pressure and contact forces, without inertia, viscosity and
// weight:
//   Π(q) = ½ EᵀD̂E − p V(q) + Σ ½ κ A ⟨H(x) − n·r⟩²,
// the contact summed over points of the mid-surface with their share A of the undeformed area. Loading and unloading
// coincide wherever the minimum is unique.
//
// The minimum is approached by creep of the Kelvin–Voigt solid, in linearly implicit steps h along which Π has to fall:
//   (∂²Π/∂q² + σ BᵀD̂B) Δq = −∂Π/∂q,   σ = τ/h.
// σ = 0 is Newton's method. A layered tire need not be stable as a static body: compressed belts and sidewalls wrinkle,
// and ∂²Π/∂q² is then not positive definite. In that case σ grows until the Cholesky factorization succeeds, and falls
// again afterwards. Only a stable equilibrium is accepted, where the factorization succeeds with σ = 0.
//
// Stiffness that the ground feels. At an equilibrium the ground moves by d, as a rigid body, and the tire sticks to it.
// Points in contact resist their motion against the ground, w u − d, with
//   C = κ A (n nᵀ + bend) + s κ A (1 − n̂ n̂ᵀ)
// s a share of the normal stiffness, so that
//   (K + Σ wᵀ C w) u = Σ wᵀ C d,   S = Σ dᵀ C d − (Σ wᵀ C d)ᵀ (K + Σ wᵀ C w)⁻¹ (Σ wᵀ C d)
// is this stiffness.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "tire/ancf/rim_clearance.hpp"
#include "tire/ancf/shell_carcass.hpp"
#include "tire/press/press_obstacle.hpp"

namespace furrow::tire {

class PressSolver {
 public:
  PressSolver(const TireFile& file, const ShellMesh& mesh, const Field& inflated, const PressObstacle& obstacle);
  ~PressSolver();

  double largest_radius() const { return largest_radius_; }  // of the inflated tire, m
  /// Height of the rim's centre over a plate that the lowest node of the inflated tire just touches, m: deflection
  /// starts there.
  double start_height() const { return start_height_; }
  /// Moves the obstacle to a deflection and finds equilibrium; `each_step` is called before each step of creep and may
  /// throw. @throws Error(physics) when there is no equilibrium, or when the tire would be in its rim.
  PressPoint press(double deflection, const std::function<void()>& each_step = {});
  /// Π at the last point, J; its derivative with respect to the deflection is the force.
  double potential() const { return potential_; }
  /// Largest difference of radius around a row of nodes, m; for the unpressed tire, the height of its wrinkles.
  double runout() const;
  /// Largest difference of the angle between a director and the axle around a row of nodes, rad. It shows wrinkles that
  /// turn the shell's thickness and keep its radius.
  double director_runout() const;
  std::vector<PressSample> footprint() const;
  /// S at the last point. @param tangential s above; 0: the ground slides. @pre press() has found an equilibrium
  GroundStiffness ground_stiffness(double tangential = 1.0);

 private:
  struct Linear;
  double evaluate();
  bool factorize();
  void assemble();
  Eigen::Matrix3d contact_matrix(const Vec3& x, double area, double tangential) const;
  double creep(double& norm);
  void contact(bool tangent);
  void move(const Field& from, const Eigen::VectorXd& change, double share);
  void follow(double top);
  double force() const { return rim_.force.z(); }
  double depth(const Vec3& x, const PressObstacle::Profile& top) const;
  Vec3 normal(const PressObstacle::Profile& top) const;
  template <class Visit>
  void contact_points(Visit visit) const;

  ShellMesh mesh_;
  ShellCarcass shell_;
  ShellLayout layout_;
  PressObstacle obstacle_;
  Vec3 left_, up_;  // the ground's y and z
  RimClearance clearance_;
  Field q_, strains_, r_;
  int around_;  // contact points of an element, around
  double largest_radius_ = 0.0, start_height_ = 0.0, pressure_norm_ = 0.0, rounding_ = 0.0;
  double top_ = std::numeric_limits<double>::max();  // of the obstacle, along n from the rim's centre, m
  Wrench rim_;                                       // at q_, in the ground's axes
  double potential_ = 0.0;                           // at q_, J
  double viscosity_ = 0.0;                           // σ
  std::unique_ptr<Linear> linear_;
};

}  // namespace furrow::tire
