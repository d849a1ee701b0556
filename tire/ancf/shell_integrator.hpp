// Implicit time integration of the ring of shell elements held by a moving rim.
//
// Over a step h from (q, v) to (q', v'), with q_f = ½ (q + q') and E, E' the strains at q, q':
//   q' − q = h v'                                                                          (1) free nodes
//   M (v' − v)/h + B(q_f)ᵀ D̂ [E' + τ (E' − E)/h] − p ∂V/∂q(q_f) = F + M g + Q              (2)
// F are the contact forces, constant or changing with the motion (shell_contact.hpp), Q the reactions at the beads. q',
// v' of the beads come from the rim.
//  - As E is quadratic in q, E' − E = B(q_f) (q' − q): strain rates vanish exactly for a rigid motion between
//    the step's ends, and the work of the internal forces is Δ(elastic energy) + ½ ΔEᵀ D̂ ΔE + (τ/h) ΔEᵀ D̂ ΔE.
//    With the ½ Δvᵀ M Δv that (1) removes, energy cannot grow; the numerical damping acts like h of
//    additional τ, 1 % of the material's. Both losses are recorded (numerical_loss), and so is the work of the
//    residual of (2) when the iteration ends (solver_loss).
//  - Velocities are those of the backward Euler rule, so modes stiffened by τ K do not ring. With trapezoidal or HHT
//    velocities they ring, and a velocity-dependent contact force that comes one interval late amplifies them.
//  - Δp and ΔL over the step are the impulses of F, M g and the spindle to round-off: the identity
//      x'×p' − x×p = x_f × Δp + Δx × ½ (p + p')
//    gives the moment impulse; its last term, O(h) for (1), is counted with the spindle.
// Forces at the middle: Simo & Tarnow (1992), The discrete energy-momentum method, ZAMP 43,
// doi:10.1007/BF00913408.
//
// The equations are solved by a quasi-Newton method: an old Cholesky factor of the tangent (sector_factor.hpp),
// corrected by BFGS pairs [Nocedal & Wright 2006, Alg. 7.4].
#pragma once

#include <cstdint>
#include <string>

#include "protocol/core/constants.hpp"
#include "tire/ancf/sector_factor.hpp"
#include "tire/ancf/shell_carcass.hpp"
#include "tire/ancf/shell_contact.hpp"
#include "tire/ancf/shell_mass.hpp"
#include "tire/tire.hpp"

namespace furrow::tire {

struct ShellIntegratorParams : SectorFactorParams {
  double tolerance = 1e-4;  // of the free residual, relative to the norm of the pressure forces
  int max_iterations = 40;  // per attempt

  /// m/s²
  Vec3 gravity = standard_gravity();
};

class ShellIntegrator {
 public:
  ShellIntegrator(const TireFile& file, const ShellMesh& mesh, const ShellIntegratorParams& params);

  /// Starts from the given coordinates and velocities (padding filled).
  void start(const Field& q, const Field& v);

  /// Gauge pressure from the next step on, Pa.
  void set_pressure(double pressure);

  /// One step of size h from the rim state `start`, where the last one ended, to `end`. `force`: contact forces,
  /// padding zero. `about`: moments are taken about this point. The wrench is what the tire exerts on the rim, the
  /// step's mean, without forces on the bead discs. @pre started; h > 0; force has the layout's size
  Outcome step(double h, const RimState& start, const RimState& end, const Field& force, const Vec3& about,
               Wrench& on_rim);

  /// Forces with tangents, in addition to those given to step(); set them before each interval.
  ShellContact& contact() { return contact_; }
  const ShellContact& contact() const { return contact_; }

  const Field& q() const { return q_; }
  const Field& v() const { return v_; }
  const Field& momenta() const { return p_; }  // M v, padding zero
  const ShellLayout& layout() const { return layout_; }
  const ShellCarcass& shell() const { return shell_; }
  const ShellMass& mass() const { return mass_; }

  double elastic_energy() const { return elastic_; }         // with what relaxing branches store, J
  double dissipation() const { return dissipation_; }        // J, cumulative
  double numerical_loss() const { return numerical_loss_; }  // J, cumulative
  double solver_loss() const { return solver_loss_; }        // J, cumulative
  /// Impulse of the solver's residual, part of the spindle's, N s, cumulative.
  const Vec3& solver_impulse() const { return solver_impulse_; }
  double potential_energy() const;  // of gravity, 0 at the world's origin, J
  std::int64_t iterations() const { return iterations_; }
  std::int64_t factorizations() const { return factor_.renewals(); }  // whole or in part
  double factor_work() const { return factor_.work(); }               // cost of the renewals, in whole factorizations
  double residual() const { return residual_; }

  /// Processor time spent in the parts of a step, s, cumulative; not part of the state.
  struct Times {
    double force = 0.0, jacobian = 0.0, factorize = 0.0, solve = 0.0, other = 0.0;
  };
  Times times() const;

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  friend void visit_fields(FieldsOf<ShellIntegrator> auto& s, auto&& visit) {
    visit(s.reference_, furrow::Field{"reference", "N"});
    visit(s.unit_force_, furrow::Field{"unit_force", "N/Pa"});
    visit(s.elastic_, furrow::Field{"elastic", "J"});
    visit(s.dissipation_, furrow::Field{"dissipation", "J"});
    visit(s.numerical_loss_, furrow::Field{"numerical_loss", "J"});
    visit(s.solver_loss_, furrow::Field{"solver_loss", "J"});
    visit(s.solver_impulse_, furrow::Field{"solver_impulse", "N s"});
    visit(s.residual_, furrow::Field{"residual"});
    visit(s.iterations_, furrow::Field{"iterations"});
  }

  void set_bead(const RimState& rim);
  void predict(double h, double share);
  void evaluate(double h, const Field& force);
  double free_norm(const Field& f) const;
  void set_reference(double pressure_force);
  void direction(const Mat3& turn, int pairs);
  bool iterate(double h, const Field& force, const Mat3& turn, bool careful, int& count, double& norm);
  void finish(double h, const RimState& start, const RimState& end, const Vec3& about, Wrench& on_rim);
  void book_losses(double h, const RimState& start, const RimState& end);

  ShellIntegratorParams params_;
  ShellMesh mesh_;
  ShellLayout layout_;
  ShellCarcass shell_;
  ShellMass mass_;
  SectorFactor factor_;

  Field q_, v_;              // state: coordinates (m, –) and velocities
  Field v_before_;           // velocities one step earlier, for the prediction
  Field p_;                  // M v
  double reference_ = 0.0;   // norm of the pressure forces, N
  double unit_force_ = 0.0;  // of the pressure forces of 1 Pa, N/Pa
  double elastic_ = 0.0, dissipation_ = 0.0, residual_ = 0.0;
  double numerical_loss_ = 0.0, solver_loss_ = 0.0;  // J
  Vec3 solver_impulse_ = Vec3::Zero();               // N s
  std::int64_t iterations_ = 0;

  ShellContact contact_;
  ShellCarcass::Step shell_step_;                                   // from q_
  Field gravity_;                                                   // M g
  Field q_new_, v_new_, p_new_, moved_, q_force_, change_, r_, d_;  // work
  std::vector<Field> s_, y_;                                        // BFGS pairs
  std::vector<double> rho_;
  Times times_;  // without those of the factor
};

}  // namespace furrow::tire
