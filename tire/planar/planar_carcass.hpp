// The tire of a planar wheel on a rim with a given motion: an annulus of triangles whose inner nodes are held.
//
// Positions r and velocities u of the nodes count from the rim's centre, in axes that do not turn with the rim: x
// forward, z up in the wheel's plane. A step h in which the centre has the velocity V', after V in the step before,
//   A = (V' − V)/h,   u' = u + h (F_int(r, u) + F_ext)/m + h (g − A),   r' = r + h u'                         (1)
// is semi-implicit Euler's of the velocities v = V + u. Held nodes go where the rim has them; what holds them is
//   R = m Δv/h − F_int − F_ext − m g,   −Σ R on the rim, −Σ r × R about its centre.                           (2)
// So momentum and angular momentum change by what acts, to round-off.
//
// Energy of a step, with the work of F_ext and R as they act and Δr = r' − r:
//   work = Δ(kinetic + elastic + potential) + viscous + numerical,
//   numerical = ½ Σ m |Δv|² + ½ Σ (F_int' − F_int)·Δr,   viscous = ½ h (P + P'),                              (3)
// P the viscous power; what (3) leaves is of third order in the elastic part and of second in the viscous one.
#pragma once

#include <vector>

#include "tire/planar/planar_ground.hpp"
#include "tire/planar/planar_wheel.hpp"

namespace furrow::tire {

/// Where the rim's centre goes in a step, and how far the rim is turned at its end.
struct PlanarRimStep {
  PlanarPoint velocity;  // V', m/s
  double angle = 0.0;    // about +y: forward rolling increases it, rad
};

/// Sums over steps.
struct PlanarSums {
  double impulse_x = 0.0, impulse_z = 0.0;  // of the tire on the rim, N s
  double turn_impulse = 0.0;                // about +y, N m s
  double rim_work = 0.0;                    // of the rim on the tire, J
  double dissipation = 0.0;                 // by viscosity, J
  double numerical_loss = 0.0;              // J
};

class PlanarCarcass {
 public:
  explicit PlanarCarcass(const PlanarParams& params);

  const PlanarMesh& mesh() const { return mesh_; }
  const PlanarElements& elements() const { return elements_; }
  const std::vector<double>& mass() const { return elements_.mass(); }  // of nodes, kg
  double total_mass() const { return total_mass_; }                     // kg
  double spin_inertia() const { return spin_inertia_; }                 // undeformed, kg m²

  /// Undeformed, moving as a rigid body with the rim.
  void place(double angle, double spin, PlanarPoint velocity);
  /// One step of h. @param load on nodes, N. @param gravity in the wheel's plane, m/s²
  /// @returns whether no triangle was turned inside out. @pre placed or restored; h > 0
  bool step(double h, const PlanarRimStep& rim, const PlanarField& load, PlanarPoint gravity,
            PlanarSums& sums);
  /// Largest stable step in the present shape, s.
  double step_limit() const;

  const PlanarField& position() const { return r_; }    // from the rim's centre, m
  const PlanarField& velocity() const { return u_; }    // likewise, m/s
  PlanarPoint centre_velocity() const { return centre_; }  // of the last step, m/s
  PlanarPoint first_moment() const;                     // Σ m r, kg m
  PlanarPoint momentum() const;                         // Σ m v, kg m/s
  double angular_momentum() const;                      // Σ m r × u about +y, kg m²/s
  double kinetic_energy() const;                        // J
  double elastic_energy() const { return elements_.energy(r_); }  // J
  double least_radius() const;                          // of the outer nodes, m

  /// @pre of this mesh
  void restore(PlanarField position, PlanarField velocity, PlanarPoint centre_velocity);

 private:
  void hold(double h, double angle);
  void renew();

  PlanarMesh mesh_;
  PlanarElements elements_;
  double total_mass_ = 0.0, spin_inertia_ = 0.0;
  std::vector<char> held_;  // of nodes
  PlanarField r_, u_;
  PlanarPoint centre_;
  PlanarField internal_, internal_before_;  // F_int, N
  PlanarField target_;                      // u' of held nodes, m/s
  double power_ = 0.0;                      // P, W
};

}  // namespace furrow::tire
