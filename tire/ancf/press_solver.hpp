// Static pressing of an inflated ring of shell elements, its beads fixed, on a frictionless obstacle z = H(x).
//
// Equilibrium of elastic, pressure and contact forces, without inertia, viscosity and weight:
//   B(q)ᵀ D̂ E(q) − p ∂V/∂q − ∂/∂q Σ ½ κ A ⟨H(x) − z⟩² = 0,
// the contact summed over points of the mid-surface with their share A of the undeformed area. All forces have
// potentials, so loading and unloading coincide wherever the equilibrium is unique.
//
// A layered tire need not be stable as a static body: where belts or sidewalls are compressed they wrinkle, and the
// tangent loses its definiteness on the way. The remedy is that of ancf/inflation.hpp: the equilibrium is approached by
// creep under the Kelvin–Voigt law, whose step h shrinks when the Cholesky factorization fails and grows otherwise. In
// the limit of large h a creep step is a Newton step of the static equations, and only a stable equilibrium is reached.
#pragma once

#include <memory>
#include <vector>

#include "tire/ancf/rim_clearance.hpp"
#include "tire/ancf/shell_ring.hpp"

namespace furrow {

/// A flat plate, or a flat-topped bar across the direction of travel with rounded edges.
struct PressObstacle {
  double height = 0.0;     // of the top above the base, m; 0: a plate
  double width = 0.0;      // of the top along x, m
  double edge = 5e-3;      // along x, over which the bar's sides rise, m
  double stiffness = 4e9;  // κ, N/m³: 0.06 mm under 240 kPa

  struct Profile {
    double height = 0.0, slope = 0.0;
  };
  /// Top at 0; the base of a bar is never touched.
  Profile at(double x) const;
};

struct PressPoint {
  double deflection = 0.0;  // m
  double force = 0.0;       // on the tire, upwards, N
  double residual = 0.0;    // of the free forces, relative to the load
  int creep_steps = 0;
  int failed_factorizations = 0;
};

/// Pressure at a point of the contact surface.
struct PressSample {
  double x = 0.0, y = 0.0;  // m, from under the rim's centre
  double area = 0.0;        // m²
  double pressure = 0.0;    // Pa
};

class PressSolver {
 public:
  PressSolver(const TireFile& file, const RingMesh& mesh, const Field& inflated,
              const PressObstacle& obstacle);
  ~PressSolver();

  /// Largest radius of the inflated tire: where deflection starts, m.
  double start_radius() const { return start_radius_; }
  /// Moves the obstacle to a deflection and finds equilibrium. @throws Error(physics) when there is none,
  /// or when the tire would stand in its rim.
  PressPoint press(double deflection);
  std::vector<PressSample> footprint() const;
  const Field& q() const { return q_; }

 private:
  struct Linear;
  bool creep(double h);
  double evaluate(double c, const Field& e_old);  // residual into r_; its norm
  double contact(bool with_tangent);              // into r_; @returns vertical force
  void assemble(double c, const Field& e_old);
  template <class Visit>
  void contact_points(Visit visit) const;

  RingMesh mesh_;
  ShellRing shell_;
  RingLayout layout_;
  PressObstacle obstacle_;
  RimClearance clearance_;
  Field q_, strains_, r_;
  double start_radius_ = 0.0, top_ = 0.0, pressure_norm_ = 0.0, force_ = 0.0;
  int failed_ = 0;
  std::unique_ptr<Linear> linear_;
};

}  // namespace furrow
