// One sphere hits a plane. The impact is computed by the solver, by an integration of the same equations without shared
// code, and by closed forms. The plane is the bin's floor or a tilted triangle mesh.
//
// Along the plane's x axis and about its y axis, with approach u = δ̇ > 0 and arm a = R − δ:
//   m u̇ = −F_e,  m v̇ = F_t,  I ω̇ = −a F_t,  sliding velocity v_s = v − a ω.
#pragma once

#include <functional>
#include <limits>

#include "terrain/dem/grain_solver.hpp"

namespace furrow::verification {

struct Elastic {
  double young = 0.0;    // Pa
  double poisson = 0.0;  // -
};

/// A sphere against a resting body so heavy that it stays at rest.
struct ImpactCase {
  double radius = 0.0;   // m
  double density = 0.0;  // kg/m³
  Elastic sphere;
  Elastic partner;
  double partner_radius = std::numeric_limits<double>::infinity();  // m
  double restitution = 1.0;                                         // -
  double friction = 0.0;                                            // -

  double mass() const;  // kg
};

/// A partner that does not deform.
Elastic rigid();

struct Motion {
  double normal = 0.0;      // speed towards the plane before, away from it after, m/s
  double tangential = 0.0;  // of the centre, m/s
  double spin = 0.0;        // rad/s; rolling along +x is positive

  /// Sliding velocity at the contact, without deformation, m/s.
  double sliding(double radius) const { return tangential - radius * spin; }
};

struct Rebound {
  Motion after;
  double duration = 0.0;     // s
  double max_overlap = 0.0;  // m
  double max_force = 0.0;    // normal, N
};

enum class Ground { plane, mesh };
const char* name_of(Ground ground);

/// Called after each step with overlap, m, time since first touch, s, and normal force, N.
using Watch = std::function<void(double, double, double)>;

/// Impact by the solver with the law mindlin; `steps`: number in the elastic contact's duration.
Rebound solver_impact(const ImpactCase& impact, const Motion& before, Ground ground, int steps,
                      const Watch& watch = {});

/// Runge–Kutta integration of the equations above with the law of Eqs. (2), (3) of mindlin_law.hpp.
Rebound integrated_impact(const ImpactCase& impact, const Motion& before);

/// Frictionless elastic impact [Hertz 1882; Johnson 1985, Contact Mechanics, § 11.4].
Rebound hertz_impact(double stiffness, double mass, double speed);

/// Rigid-body rebound of a sphere that slides throughout: v' = v − μ (1 + e) v_n, ω' = ω + 5/2 μ (1 + e) v_n / R for
/// v_s > 0; holds for v_s ≥ 7/2 μ (1 + e) v_n.
Motion sliding_rebound(const ImpactCase& impact, const Motion& before);
bool slides_throughout(const ImpactCase& impact, const Motion& before);

/// Tangential restitution −v_s'/v_s of an undamped impact without slip: the sliding velocity is a hypergeometric
/// function of (δ/δ_max)^{5/2} (derivation in the source file).
double no_slip_restitution(const ImpactCase& impact);

}  // namespace furrow::verification
