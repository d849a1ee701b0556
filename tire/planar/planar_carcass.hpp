// The tire of a planar wheel on a rim with a given motion: an annulus of triangles whose inner nodes are held. With an
// elastic disc the mesh goes on to the axle, and the rim holds the disc's middle node and the ring of nodes around it.
// In the source the middle node alone is linked, and couples act on the disc's edge.
//
// Positions r and velocities u of the nodes are relative to the rim's centre, in axes that do not turn with the rim: x
// forward, z up in the wheel's plane. A step h in which the centre has the velocity V', after V in the step before,
//   A = (V' − V)/h,   u' = u + h (F_int(r, u) + F_ext)/m + h (g − A),   r' = r + h u'                         (1)
// is the semi-implicit Euler rule for the velocities v = V + u. Held nodes move with the rim; the force that holds them
// is
//   R = m Δv/h − F_int − F_ext − m g,   −Σ R on the rim, −Σ r × R about its centre.                           (2)
// So momentum and angular momentum change by the acting impulses, to round-off.
//
// The fourth-order Runge–Kutta method takes the same steps h with held nodes on straight ways. F_int and the forces of
// the tire's own contact (tread_contact.hpp) are those of its stages, F_ext is constant. Momentum changes by the means
// of these forces.
//
// Energy of a step, with the work of F_ext and R as they act and Δr = r' − r:
//   work = Δ(kinetic + elastic + potential) + viscous + numerical,
//   numerical = ½ Σ m |Δv|² + ½ Σ (F_int' − F_int)·Δr,   viscous = ½ h (P + P'),                              (3)
// P the viscous power. The error of (3) is of third order in h in the elastic part and of second order in the viscous
// part. Of the Runge–Kutta method only ½ Σ m |Δv|² of held nodes is lost; what it loses by itself is an error of (3).
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "protocol/core/fields.hpp"
#include "tire/extruded/plane_model.hpp"
#include "tire/planar/planar_ground.hpp"
#include "tire/planar/planar_params.hpp"
#include "tire/planar/rubbing_contact.hpp"

namespace furrow::tire {

class PlanarCarcass final : public PlaneModel {
 public:
  explicit PlanarCarcass(const PlanarParams& params);

  /// Gives the tire a contact of its own. @pre before place()
  void set_contact(std::unique_ptr<PlaneContact> contact) { contact_ = std::move(contact); }

  const PlanarMesh& mesh() const { return mesh_; }
  const PlanarElements& elements() const { return elements_; }
  const std::vector<double>& mass() const { return elements_.mass(); }  // of nodes, kg
  double total_mass() const { return total_mass_; }                     // kg
  const std::vector<int>& held() const { return held_nodes_; }          // nodes that move with the rim
  double spin_inertia() const { return spin_inertia_; }                 // undeformed, kg m²
  /// Largest stable step in the present shape, s.
  double step_limit() const;
  double least_radius() const;  // of the outer nodes, m

  int coordinates() const override { return 2 * mesh_.nodes(); }
  const std::vector<int>& tread() const override { return tread_; }
  double tread_mass() const override;
  void set_pressure(double) override {}
  void place(double angle, double spin, PlanarPoint velocity) override;
  /// Explicit steps are a share of the largest stable one, which is checked again at intervals.
  Outcome parts(double h, int& count) override;
  PlaneContact* contact() override { return contact_.get(); }
  Outcome step(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity,
               PlaneSums& sums) override;
  Outcome check() const override;

  const PlanarField& position() const override { return r_; }
  const PlanarField& velocity() const override { return u_; }
  PlanarPoint centre_velocity() const override { return centre_; }
  PlanarPoint first_moment() const override;
  PlanarPoint momentum() const override;
  double angular_momentum() const override;
  double kinetic_energy() const override;
  double elastic_energy() const override { return elements_.energy(r_); }
  double pressure_energy() const override { return 0.0; }

  NamedValues figures() const override {
    return {{"explicit_steps", static_cast<double>(steps_)}, {"step_limit_s", limit_}};
  }
  void save(Archive& archive) const override;
  void restore(const Archive& archive) override;

 private:
  void hold(double h, double angle);
  void renew();
  bool euler(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity, PlaneSums& sums);
  bool runge_kutta(double h, const PlaneRimStep& rim, const PlanarField& load, PlanarPoint gravity, PlaneSums& sums);
  const PlanarField& touch(const PlanarField& x, double h, double share);

  friend void visit_fields(FieldsOf<PlanarCarcass> auto& s, auto&& visit) {
    visit(s.centre_.x, Field{"centre_velocity_x", "m/s"});
    visit(s.centre_.z, Field{"centre_velocity_z", "m/s"});
    visit(s.limit_, Field{"step_limit", "s"});
    visit(s.steps_, Field{"steps", ""});
    visit(s.since_check_, Field{"steps_since_check", ""});
  }

  PlanarMesh mesh_;
  PlanarElements elements_;
  PlanarIntegrator integrator_;
  double rim_radius_, share_;
  std::unique_ptr<PlaneContact> contact_;  // null: the tire is given its forces
  std::vector<int> tread_, held_nodes_;
  double total_mass_ = 0.0, spin_inertia_ = 0.0;
  std::vector<char> held_;  // of nodes
  PlanarField r_, u_;
  PlanarPoint centre_;
  PlanarField internal_, internal_before_;  // F_int, N
  PlanarField target_;                      // u' of held nodes, m/s
  PlanarField touching_;                    // forces of contact_, N
  PlanarField v_;                           // of nodes in space, m/s
  PlanarState start_, sum_;                 // of a Runge–Kutta step
  PlanarField stage_;                       // positions, m
  double power_ = 0.0;                      // P, W
  double limit_ = 0.0;                      // of the last check, s
  std::int64_t steps_ = 0, since_check_ = 0;
};

}  // namespace furrow::tire
