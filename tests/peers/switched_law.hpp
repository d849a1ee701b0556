// The engine's law `mindlin` with a switch for each difference from LIGGGHTS's `hertz` + `tangential history`.
//
// For the comparison, it is included before the engine's own sources (CMakeLists.txt) and replaces MindlinLaw; the rest
// of the engine is unchanged. Its coefficients also contain the sum of the switches; 0 is the engine's law, kAll the
// law of LIGGGHTS 3.8.
#pragma once

#include "terrain/dem/contact/mindlin_law.hpp"

namespace furrow::terrain::dem {

using OwnLaw = MindlinLaw;

struct SwitchedLaw : MindlinLaw {
  static constexpr bool kSizes = false;

  template <class S>
  struct Coefficients : OwnLaw::Coefficients<S> {
    S switches{};
  };

  enum Switch {
    kRescaleOnLoading = 1,  // spring = 8 G* √(R*δ) × displacement: rescaled by √(δ/δ_old) on loading too
    kPlainProjection = 2,   // turned by projection only, which shortens it
    kNoSpin = 4,            // not turned with the spin about the normal
    kDamperApart = 8,       // only the spring is cut at the limit, and if it is, there is no damper
    kLimitOfSize = 16,      // limit μ |F_e|: friction also while the damper pulls
    kAll = 31
  };

  template <bool kRolling, class C, class S, class T>
  static inline ContactForce<T> force(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
                                      ContactHistory<T>& history) {
    int on = 0;  // the same in all lanes
    if constexpr (std::is_arithmetic_v<C>) {
      on = static_cast<int>(c.switches);
    } else {
      on = static_cast<int>(c.switches[0]);
    }
    if (kRolling || on == 0) return OwnLaw::force<kRolling>(c, dt, at, history);
    const T zero = constant<T>(0.0), one = constant<T>(1.0), tiny = constant<T>(kTiny);
    const T s = at.root_overlap, q = root(s);
    const T v_n = dot(at.velocity, at.normal);
    const Triple<T> v_t = at.velocity - v_n * at.normal;
    const T hertz = c.stiffness * s * at.overlap;

    ContactForce<T> f;
    f.elastic = hertz - c.damping * q * v_n;
    f.normal = f.elastic - c.cohesion_force;
    f.energy = (constant<T>(0.4) * hertz - c.cohesion_force) * at.overlap;
    f.rolling = {zero, zero, zero};
    const T limit = c.friction * larger(f.elastic, on & kLimitOfSize ? -f.elastic : zero);

    const T scale = s / larger(history.root_overlap, on & kRescaleOnLoading ? tiny : s);
    const T angle = on & kNoSpin ? zero : dt * at.spin;
    const Triple<T>& old = history.tangential;
    const Triple<T> spun = old + angle * cross(at.normal, old);
    Triple<T> spring = on & kPlainProjection ? scale * (spun - dot(spun, at.normal) * at.normal)
                                             : turn_with_contact(old, at.normal, angle, scale);
    spring = spring - (c.shear_stiffness * dt * s) * v_t;
    const Triple<T> damper = (-c.shear_damping * q) * v_t;
    if (on & kDamperApart) {
      const T square = dot(spring, spring);
      const auto over = square > limit * limit;
      spring = (over ? limit / root(larger(square, tiny)) : one) * spring;
      f.tangential = spring + (over ? zero : one) * damper;
    } else {
      f.tangential = cut_at_limit(spring, damper, limit);
    }
    history.tangential = spring;
    history.root_overlap = s;
    return f;
  }
};

}  // namespace furrow::terrain::dem

#define MindlinLaw SwitchedLaw
