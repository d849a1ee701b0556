// Implicit time integration of the ring of shell elements held by a moving rim.
//
// Over a step h from (q, v) to (q', v'), with q_f = ½ (q + q') and E, E' the strains at q, q':
//   q' − q = h v'                                                                          (1) free nodes
//   M (v' − v)/h + B(q_f)ᵀ D̂ [E' + τ (E' − E)/h] − p ∂V/∂q(q_f) = F + M g + Q              (2)
// F are the contact forces, constant over the step, Q the reactions at the beads. q', v' of the beads come from
// the rim.
//  - As E is quadratic in q, E' − E = B(q_f) (q' − q): strain rates vanish exactly for a rigid motion between
//    the step's ends, and the work of the internal forces is Δ(elastic energy) + ½ ΔEᵀ D̂ ΔE + (τ/h) ΔEᵀ D̂ ΔE.
//    With the ½ Δvᵀ M Δv that (1) removes, energy cannot grow; the numerical damping acts like h of
//    additional τ, 1 % of the material's.
//  - Velocities are those of the backward Euler rule: what is stiff through τ K does not ring, as it does with
//    trapezoidal or HHT velocities, where a contact force that comes one interval late and depends on
//    velocity would feed it.
//  - Δp and ΔL over the step are the impulses of F, M g and the spindle to round-off: the identity
//      x'×p' − x×p = x_f × Δp + Δx × ½ (p + p')
//    gives the moment impulse; its last term, O(h) for (1), is counted with the spindle.
// Forces at the middle: Simo & Tarnow (1992), The discrete energy-momentum method, ZAMP 43,
// doi:10.1007/BF00913408.
//
// The equations are solved by a quasi-Newton method: an old Cholesky factor of the tangent, turned and
// renumbered to the present orientation, corrected by BFGS pairs [Nocedal & Wright 2006, Alg. 7.4];
// refactored when it has aged.
#pragma once

#include <cstdint>
#include <string>

#include "tire/ancf/ring_factor.hpp"
#include "tire/ancf/ring_mass.hpp"
#include "tire/ancf/shell_ring.hpp"
#include "tire/tire.hpp"

namespace furrow {

struct RingIntegratorParams {
  double damping = 0.005;   // τ, s
  double tolerance = 1e-4;  // of the free residual, relative to the norm of the pressure forces
  int max_iterations = 40;  // per attempt
  int slow_iterations = 5;  // more than these, and kAged more than when it was new: the factor is renewed
  int slots = 4;            // factors kept, one per fraction of a pitch of rolling
  int threads = 1;          // of a step; results do not depend on them
};

class RingIntegrator {
 public:
  RingIntegrator(const TireFile& file, const RingMesh& mesh, const RingIntegratorParams& params);

  /// Starts from the given coordinates and velocities (padding filled).
  void start(const Field& q, const Field& v);

  /// One step of size h to the rim state `end`. `force`: contact forces, padding zero. `about`: moments are
  /// taken about this point. The wrench is what the tire exerts on the rim, the step's mean, without forces
  /// on the bead discs.
  TireStatus step(double h, const RimState& end, const Field& force, const Vec3& about, Wrench& on_rim);

  const Field& q() const { return q_; }
  const Field& v() const { return v_; }
  const RingLayout& layout() const { return layout_; }
  const ShellRing& shell() const { return shell_; }
  const RingMass& mass() const { return mass_; }
  const RingIntegratorParams& params() const { return params_; }
  int unknowns() const { return factor_.unknowns(); }

  double elastic_energy() const { return elastic_; }   // J
  double dissipation() const { return dissipation_; }  // J, cumulative
  std::int64_t iterations() const { return iterations_; }
  std::int64_t factorizations() const { return factorizations_; }
  double residual() const { return residual_; }

  /// Processor time spent in the parts of a step, s, cumulative; not part of the state.
  struct Times {
    double force = 0.0, jacobian = 0.0, factorize = 0.0, solve = 0.0, other = 0.0;
  };
  const Times& times() const { return times_; }

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  /// What a factor was made from: enough to make it again.
  struct Slot {
    bool valid = false, stale = false;
    Mat3 turn = Mat3::Identity();  // rim orientation
    double h = 0.0;                // s
    int first_iterations = -1;     // needed when it was new; -1 before
    Field q_old, q_new;
  };
  struct Placement {
    int slot = 0;
    Mat3 turn = Mat3::Identity();
    int shift = 0;
  };

  void set_bead(const RimState& rim);
  void predict(double h, double share);
  void evaluate(double h, const Field& force);
  double free_norm(const Field& f) const;
  double coefficient(double h) const { return 1.0 + params_.damping / h; }
  bool make_factor(Slot& slot, int index);
  Placement place_factor(double h, const Mat3& orientation, bool renew);
  void direction(const Placement& at, int pairs);
  void judge(Slot& slot, int count);
  bool iterate(double h, const Field& force, Placement& at, int& count, double& norm);
  void finish(double h, const Vec3& about, Wrench& on_rim);

  RingIntegratorParams params_;
  RingMesh mesh_;
  RingLayout layout_;
  ShellRing shell_;
  RingMass mass_;
  RingFactor factor_;
  std::vector<Slot> slots_;

  Field q_, v_;             // state: coordinates (m, –) and velocities
  Field v_before_;          // velocities one step earlier, for the prediction
  double reference_ = 0.0;  // norm of the pressure forces, N
  double elastic_ = 0.0, dissipation_ = 0.0, residual_ = 0.0;
  std::int64_t iterations_ = 0, factorizations_ = 0;

  Field strains_;                                   // at q_
  Field gravity_;                                   // M g
  Field q_new_, v_new_, q_force_, change_, r_, d_;  // work
  std::vector<Field> s_, y_;                        // BFGS pairs
  std::vector<double> rho_;
  Times times_;
};

}  // namespace furrow
