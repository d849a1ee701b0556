// The flexible ring in motion on a rim with a given motion, in the plane of its wheel.
//
// Masses. Two thin rings have the file's mass m and spin inertia I: the belt, m_b at R, on its segments, and the rest m
// − m_b at the rim's radius ρ, which moves with the rim:
//   m_b R² + (m − m_b) ρ² = I.                                                                                (1)
//
// Positions r_j and velocities w_j of the segments are relative to the rim's centre, in axes that do not turn with the
// rim. Displacements q_j = (u, v) are relative to the rim, which is turned by α: r_j = R(α) (R e_r + q_j). So inertia
// is complete, with centrifugal and Coriolis terms [Gong 1993, A study of in-plane dynamics of tires, TU Delft, ch. 3,
// writes them out], and a rigid rotation causes no strain. A step h, in which the centre has
// the velocity V', after V before,
//   r' = r + h w',   m_j (w' − w + V' − V)/h = −cos δ R(α_m) F + f + m_j g,                                   (2)
//   F = ∂Π(q_m) + (τ/h) K(q_m) (q' − q),   q_m = ½ (q + q'),   α_m = ½ (α + α'),   δ = ½ (α' − α),
// has the energy Π of ring_mechanics.hpp, the contact forces f, and K, the tangent of Π without air and hoop tension:
// structural damping (Kelvin and Voigt) of belt and sidewall with the time constant τ. Exactly,
//   q' − q = R(−α_m) [cos δ (r' − r) − 2 sin δ J r_m],   J a right angle,   r_m = ½ (r + r').                  (3)
//
// Momentum and angular momentum change by the acting impulses, to round-off, whatever the residual of (2). Energy, with
// Δx = Δr + h V':
//   f·Δx + m g·Δx + rim = Δ(kinetic + Π) + ½ Σ m |Δv|² + (τ/h) Δqᵀ K Δq,                                      (4)
// up to third order in h, from the curvature of sidewall and hoop tension. The term in Δv is the numerical loss, which
// acts like h/2 of additional τ; it cannot be negative. As with the shell's rule (shell_integrator.hpp), stiff motion
// does not ring.
//
// Newton's method solves (2) for q' − q with one factor per step (folded_band.hpp). The factor leaves out the turn 2δ
// of the step; the Sherman–Morrison formula adds the air's rank of one.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/fields.hpp"
#include "tire/extruded/plane_model.hpp"
#include "tire/ring/folded_band.hpp"
#include "tire/ring/ring_mechanics.hpp"

namespace furrow::tire {

class RingCarcass final : public PlaneModel {
 public:
  /// @pre as for RingMechanics and belt_mass(); damping ≥ 0
  RingCarcass(const RingParams& params, const RingMotion& motion);

  const RingMechanics& ring() const { return ring_; }
  const RingField& displacement() const { return q_; }

  int coordinates() const override { return 2 * n_; }
  const std::vector<int>& tread() const override { return tread_; }
  double tread_mass() const override { return node_mass_ * n_; }
  /// pressure_energy() leaves out the energy that a changing pressure adds.
  void set_pressure(double pressure) override;
  void place(double angle, double spin, PlanarPoint velocity) override;
  Outcome parts(double, int& count) override { return count = 1, Outcome{}; }
  Outcome step(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
               PlaneSums& sums) override;
  Outcome check() const override;

  const PlanarField& position() const override { return r_; }
  const PlanarField& velocity() const override { return w_; }
  PlanarPoint centre_velocity() const override { return centre_; }
  PlanarPoint first_moment() const override;
  PlanarPoint momentum() const override;
  double angular_momentum() const override;
  double kinetic_energy() const override;
  double elastic_energy() const override { return ring_.energy(q_) - ring_.air_energy(q_); }
  double pressure_energy() const override { return ring_.air_energy(q_) - pumped_; }

  NamedValues figures() const override {
    return {{"newton_iterations", static_cast<double>(iterations_)}, {"residual", residual_}};
  }
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  struct Local {
    double u, v;  // along e_r, e_t
  };
  /// A vector of the plane in the axes of a segment; c and s are cosine and sine of the rim's angle.
  Local local(int j, double c, double s, double x, double z) const;
  PlanarPoint plane(int j, double c, double s, Local p) const;

  void aim(double h, double turn, double middle, PlanarPoint acceleration, const PlanarField& load,
           PlanarPoint gravity);
  bool factorize(double h);
  double residual(double h, double turn);
  void correct();
  bool solve(double h, double turn);
  void move(double h, const PlaneRimStep& rim, double turn, const PlanarField& load, PlanarPoint gravity,
            PlaneSums& sums);
  void lay_out();

  friend void visit_fields(FieldsOf<RingCarcass> auto& s, auto&& visit) {
    visit(s.angle_, Field{"angle", "rad"});
    visit(s.spin_, Field{"spin", "rad/s"});
    visit(s.centre_.x, Field{"centre_velocity_x", "m/s"});
    visit(s.centre_.z, Field{"centre_velocity_z", "m/s"});
    visit(s.pumped_, Field{"pumped", "J"});
    visit(s.iterations_, Field{"iterations", ""});
    visit(s.residual_, Field{"residual", ""});
  }

  RingMechanics ring_;
  FoldedBand band_;
  int n_;
  double rim_radius_, node_mass_, rest_mass_, rest_inertia_, damping_;
  std::vector<int> tread_;
  std::vector<double> sine_, cosine_;  // of e_r from the top of the rim forwards

  RingField q_;
  PlanarField r_, w_, r_before_;
  double angle_ = 0.0, spin_ = 0.0;  // α; α̇ of the last step
  PlanarPoint centre_;               // V
  double pumped_ = 0.0;              // J, by changing pressures
  std::int64_t iterations_ = 0;
  double residual_ = 0.0;  // of the last step, relative to the force that moves a segment by the radius

  RingField change_, middle_, force_, damped_;  // q' − q, q_m, ∂Π(q_m), K (q' − q)
  RingField target_, left_;                     // of (2), in axes turned by α_m: known terms, residual; N
  RingTangent tangent_;
  std::vector<double> lanes_, air_;  // right-hand sides; A⁻¹ 1
  double air_share_ = 0.0;
};

}  // namespace furrow::tire
