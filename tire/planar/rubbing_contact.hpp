// Contact of a planar tire in motion with rigid ground, in steps of Δt: equations (15) to (19) of the source
// (planar_material.hpp). As at rest (planar_contact.hpp), but
//   F = c h,   d = ½ F/m Δt² + v_n Δt,   F ← F h/d where d > h,   F_f = min(f F, |v_t| m/Δt),                   (1)
// with v_n > 0 if they separate. A force pushes a node at most out of the ground, and friction against the sliding
// velocity v_t at most stops it. A corner of the ground pushes a side of the tire; m is then the mass of the side's
// point, 1/m = (1 − s)²/m_a + s²/m_b. The source has v_t in the wheel's plane alone; here it may have a part across.
#pragma once

#include <vector>

#include "tire/planar/planar_contact.hpp"

namespace furrow::tire {

/// F of (1), N. @param separation v_n, m/s. @pre depth ≥ 0; mass, step > 0
double planar_normal_force(double stiffness, double depth, double separation, double mass, double step);
/// F_f of (1), N, not negative.
double planar_friction_force(double friction, double normal, double sliding, double mass, double step);

/// Positions (m) and velocities (m/s) of all nodes.
struct PlanarState {
  PlanarField x, v;
};

class RubbingContact : public PlanarContact {
 public:
  using PlanarContact::PlanarContact;

  /// Finds all touches, with the forces (1). Reads the outer nodes alone.
  /// @param across the nodes' velocities across the plane, m/s; empty: none
  void rub(const PlanarState& state, const std::vector<double>& mass, double step,
           const std::vector<double>& across = {});
  /// The same without velocities across, and adds the forces.
  void load(const PlanarState& state, const std::vector<double>& mass, double step, PlanarField& force);
  double force_x() const;  // on the tire, N
};

}  // namespace furrow::tire
