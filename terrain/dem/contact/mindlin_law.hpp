// Law mindlin: Hertz–Mindlin.
//   F_e = K δ^{3/2} − c_n δ^{1/4} v_n,     K = 4/3 E* √R*,   c_n δ^{1/4} = 2 √(5/6) β √(2 E* √(R*δ) m*)           (2)
//   β = −ln e / √(ln²e + π²), β = 1 for e = 0 [Antypov & Elliott 2011, doi:10.1209/0295-5075/94/50004]
//   dF_t = −8 G* √(R*δ) v_t dt, turned with the normal and with the mean spin about it, rescaled by √(δ/δ_old) on
//   unloading [Thornton, Cummins & Cleary 2013, doi:10.1016/j.powtec.2012.08.012]; damping as in (2) with 8 G* for
//   2 E* and 2/7 m* for m*, the mass with which a sphere's surface resists sliding                                (3)
//   the sum of spring and damper is cut at the Coulomb limit, and the spring keeps the rest.
//   Rolling resistance: elastic–plastic spring–dashpot, k_r = k_t R*², cut at μ_r R* F_e
//   [Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030]                                                            (4)
//
// Mixing: μ, e, c_t minimum; 1/E* = Σ(1−ν²)/E, 1/G* = Σ 2(2−ν)(1+ν)/E.
//
// Losses. Spring and damper are in parallel; a slider that gives way at the Coulomb limit is in series with both. Of
// the displacement v_t dt of a step the slider takes s, and the rest e stretches the spring. S′ is the spring turned
// and rescaled, S the spring after the step, k = k_t √δ, D = −c_t δ^¼ v_t, F = S + D:
//   s = (S − S′ + k v_t dt)/k,   e = v_t dt − s                                                                   (5)
//   sliding              −F·v_t dt + ½ (S′ + S)·e while it slides: friction's work, less the part stored in the spring
//   tangential damping   −D·v_t dt while it holds
//   opening              |S_old|²/2k_old − |S′|²/2k ≥ 0: what the spring gives up as the normal load changes, by
//                        rescaling on unloading and by k on loading; ½ (S′ + S)·e while the contact pulls and so bears
//                        no friction; and all energy still in the spring when the contact ends
//   normal damping       c_n δ^¼ v_n²
// A contact that parts always pulls in the end, F_e < 0. The law then sets S = −D: the spring takes up energy that no
// force gave, and gives it up when the contact ends. Both are opening, and cancel.
// Rolling resistance follows the same formulas for torque and relative spin; all its losses are one mechanism, rolling.
#pragma once

#include <cmath>
#include <numbers>

#include "terrain/dem/contact/contact.hpp"
#include "terrain/dem/contact/size_scale.hpp"

namespace furrow::terrain::dem {

struct MindlinLaw {
  static constexpr const char* kName = "mindlin";
  static constexpr const char* kStiffnessKey = "young_modulus";
  static constexpr bool kHistory = true, kSizes = true;

  template <class S>
  struct Coefficients {
    S stiffness{};        // K, N/m^1.5
    S damping{};          // c_n, N s/m^1.25
    S shear_stiffness{};  // 8 G* √R*, N/m^1.5
    S shear_damping{};    // N s/m^1.25
    S friction{};         // μ, -
    S cohesion_force{};   // F_c, N
    S rolling_arm{};      // μ_r R*, m
    S rolling_radius{};   // R*, m
    S rolling_damping{};  // N m s/m^0.25
  };

  template <class Pair, class Options>
  static Coefficients<double> mix(const Pair& pair, const Options&) {
    const auto &a = pair.a, &b = pair.b;
    const double r = pair.reduced_radius, root_r = std::sqrt(r);
    const double e_star = 1.0 / ((1.0 - a.poisson_ratio * a.poisson_ratio) / a.young_modulus +
                                 (1.0 - b.poisson_ratio * b.poisson_ratio) / b.young_modulus);
    const double g_star = 1.0 / (2.0 * (2.0 - a.poisson_ratio) * (1.0 + a.poisson_ratio) / a.young_modulus +
                                 2.0 * (2.0 - b.poisson_ratio) * (1.0 + b.poisson_ratio) / b.young_modulus);
    const double factor = 2.0 * std::sqrt(5.0 / 6.0) * damping_ratio(smaller(a.restitution, b.restitution));
    Coefficients<double> c;
    c.stiffness = 4.0 / 3.0 * e_star * root_r;
    c.damping = factor * std::sqrt(2.0 * e_star * root_r * pair.mass);
    c.shear_stiffness = 8.0 * g_star * root_r;
    c.shear_damping = factor * std::sqrt(c.shear_stiffness * pair.slide_mass);
    c.friction = pair.friction;
    c.cohesion_force = pair.cohesion_force();
    c.rolling_arm = pair.rolling * r;
    c.rolling_radius = r;
    c.rolling_damping = 2.0 * kRollingDampingRatio * std::sqrt(c.shear_stiffness * r * r * pair.inertia);
    return c;
  }

  /// K, k_t ∝ R*^½,   c_n, c_t ∝ (R*^½ m*)^½,   F_c ∝ min(r)²,   μ_r R* ∝ R*,   c_r ∝ (R*^{5/2} I*)^½.
  template <class S, class T>
  FURROW_HD static inline Coefficients<T> scaled(const Coefficients<S>& c, const SizeScale<T>& s) {
    const T root_r = root(s.radius);
    Coefficients<T> out;
    out.stiffness = c.stiffness * root_r;
    out.damping = c.damping * root(root_r * s.mass);
    out.shear_stiffness = c.shear_stiffness * root_r;
    out.shear_damping = c.shear_damping * root(root_r * s.slide_mass);
    out.friction = constant<T>(0.0) + c.friction;
    out.cohesion_force = c.cohesion_force * (s.smaller * s.smaller);
    out.rolling_arm = c.rolling_arm * s.radius;
    out.rolling_radius = c.rolling_radius * s.radius;
    out.rolling_damping = c.rolling_damping * s.radius * root(root_r * s.inertia);
    return out;
  }

  template <bool kRolling, class C, class S, class T>
  FURROW_HD static inline ContactForce<T> force(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
                                                ContactHistory<T>& history) {
    const T zero = constant<T>(0.0);
    const T s = at.root_overlap, q = root(s);
    const T v_n = dot(at.velocity, at.normal);
    const Triple<T> v_t = at.velocity - v_n * at.normal;
    const T hertz = c.stiffness * s * at.overlap;

    ContactForce<T> f;
    f.elastic = hertz - c.damping * q * v_n;  // (2)
    f.normal = f.elastic - c.cohesion_force;  // (1)
    f.energy = (constant<T>(0.4) * hertz - c.cohesion_force) * at.overlap;
    const T bearing = larger(f.elastic, zero);

    const T unloading = s / larger(history.root_overlap, s);
    const T angle = dt * at.spin;
    Triple<T> spring = turn_with_contact(history.tangential, at.normal, angle, unloading);
    spring = spring - (c.shear_stiffness * dt * s) * v_t;  // (3)
    const Triple<T> damper = (-c.shear_damping * q) * v_t;
    f.tangential = cut_at_limit(spring, damper, c.friction * bearing);
    history.tangential = spring;
    history.root_overlap = s;

    if constexpr (kRolling) {  // (4)
      const Triple<T> w = at.roll - dot(at.roll, at.normal) * at.normal;
      const C r2 = c.rolling_radius * c.rolling_radius;
      Triple<T> torque = turn_with_contact(history.rolling, at.normal, angle, unloading);
      torque = torque - (c.shear_stiffness * r2 * dt * s) * w;
      const Triple<T> brake = (-c.rolling_damping * q) * w;
      f.rolling = cut_at_limit(torque, brake, c.rolling_arm * bearing);
      history.rolling = torque;
    } else {
      f.rolling = {zero, zero, zero};
    }
    return f;
  }

  template <bool kRolling, class C, class S, class T>
  FURROW_HD static inline ContactSampleOf<T> sample(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
                                                    const ContactHistory<T>& history) {
    const T zero = constant<T>(0.0), per_step = constant<T>(1.0) / (zero + dt);
    const T s = at.root_overlap, q = root(s);
    const T v_n = dot(at.velocity, at.normal);
    const T bearing = larger(c.stiffness * s * at.overlap - c.damping * q * v_n, zero);
    ContactSampleOf<T> out;
    out.power.normal_damping = c.damping * q * v_n * v_n;
    out.stored.cohesion = -(c.cohesion_force * at.overlap);
    const auto spring = [&](const Triple<T>& before, T stiffness, T viscosity, const Triple<T>& rate, T limit) {
      return spring_losses<T>({.before = before,
                               .root_before = history.root_overlap,
                               .root = s,
                               .normal = at.normal,
                               .angle = dt * at.spin,
                               .stiffness = stiffness,
                               .viscosity = viscosity,
                               .rate = rate,
                               .limit = limit},
                              dt);
    };
    // Without friction there is no spring, although the law's history contains what the damper was cut by.
    const auto rubs = zero + c.friction > zero;
    const T k = c.shear_stiffness * s;
    const Triple<T> v_t = at.velocity - v_n * at.normal;
    const auto t = spring(history.tangential, k, c.shear_damping * q, v_t, c.friction * bearing);
    out.power.sliding = rubs ? per_step * t.slid : zero;
    out.power.tangential_damping = rubs ? per_step * t.damped : zero;
    out.power.opening = rubs ? per_step * t.opened : zero;
    out.stored.tangential = rubs ? t.stored : zero;
    if constexpr (kRolling) {
      const auto resists = zero + c.rolling_arm > zero;
      const Triple<T> w = at.roll - dot(at.roll, at.normal) * at.normal;
      const auto r = spring(history.rolling, c.rolling_radius * c.rolling_radius * k, c.rolling_damping * q, w,
                            c.rolling_arm * bearing);
      out.power.rolling = resists ? per_step * (r.slid + r.damped + r.opened) : zero;
      out.stored.tangential += resists ? r.stored : zero;
    }
    return out;
  }

  FURROW_HD static inline Stored held(const Coefficients<double>& c, double overlap,
                                      const ContactHistory<double>& history) {
    Stored out{.cohesion = -(c.cohesion_force * overlap), .tangential = 0.0};
    if (!(history.root_overlap > 0.0) || !(c.shear_stiffness > 0.0)) return out;
    const double k = c.shear_stiffness * history.root_overlap, r2 = c.rolling_radius * c.rolling_radius;
    if (c.friction > 0.0) out.tangential += 0.5 * dot(history.tangential, history.tangential) / k;
    if (c.rolling_arm > 0.0) out.tangential += 0.5 * dot(history.rolling, history.rolling) / (k * r2);
    return out;
  }

  /// k_n = dF/dδ = 3/2 K √δ, c_n = c_n δ^{1/4}; while friction holds, k_t = 8 G* √(R*δ) and its damping. The change of
  /// the dampers with δ is neglected.
  FURROW_HD static inline ContactStiffness tangent(const Coefficients<double>& c, const ContactMotion<double>& at,
                                                   const ContactForce<double>& f, double share) {
    ContactStiffness t;
    if (!(f.elastic > 0.0)) return t;
    const double s = at.root_overlap, q = std::sqrt(s);
    t.k_n = share * 1.5 * c.stiffness * s;
    t.c_n = share * c.damping * q;
    if (std::sqrt(dot(f.tangential, f.tangential)) < kSlides * c.friction * f.elastic) {
      t.k_t = share * c.shear_stiffness * s;
      t.c_t = share * c.shear_damping * q;
    }
    const double most = kSlides * c.rolling_arm * f.elastic;
    if (dot(f.rolling, f.rolling) < most * most) {
      t.k_r = share * c.shear_stiffness * c.rolling_radius * c.rolling_radius * s;
      t.c_r = share * c.rolling_damping * q;
    }
    return t;
  }

  template <class Options>
  static StableStep stable_step(const Coefficients<double>& c, const Options&, double mass, double overlap) {
    const double s = std::sqrt(overlap), q = std::sqrt(s);
    return stable_oscillation(s * stiffest_mode(1.5 * c.stiffness, c.shear_stiffness, mass),
                              q * stiffest_mode(c.damping, c.shear_damping, mass), 4.0);
  }

  static double resting_force(const Coefficients<double>& c, double overlap) { return hertz_force(c, overlap); }
  static double resting_overlap(const Coefficients<double>& c, double force) { return hertz_overlap(c, force); }
  /// Young's modulus of the grains, Pa.
  template <class Options>
  static double young_modulus(const Options& options) {
    return options.young_modulus;
  }
  template <class Options>
  static bool can_rest(const Options&) {
    return true;
  }
  /// Calls require(key, value, fits, expected) for the law's requirements on a surface.
  template <class Material, class Require>
  static void check(const Material& m, const Require& require) {
    require("young_modulus", m.young_modulus, m.young_modulus > 0.0, "above 0 Pa");
    require("poisson_ratio", m.poisson_ratio, m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5,
            "above -1 and at most 0.5");
    require("restitution", m.restitution, m.restitution >= 0.0 && m.restitution <= 1.0, "0 to 1");
  }

 private:
  static constexpr double kRollingDampingRatio =
      0.3;                                  // of critical damping in the rolling spring [Ai et al. 2011, §4.2]
  static constexpr double kSlides = 0.999;  // friction above this share of its limit slides

  /// β of Eq. (2).
  static double damping_ratio(double restitution) {
    if (restitution <= 0.0) return 1.0;
    const double l = std::log(smaller(restitution, 1.0));
    return -l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
  }

  /// One of the two springs in one evaluation, with its damper and slider.
  template <class T>
  struct SpringStep {
    Triple<T> before;     // its force when last evaluated
    T root_before, root;  // √δ then and now, √m
    Triple<T> normal;
    T angle;         // turn of the contact about its normal
    T stiffness;     // k now
    T viscosity;     // of the damper
    Triple<T> rate;  // of its deformation
    T limit;         // of spring + damper
  };
  template <class T>
  struct SpringLosses {
    T stored, slid, damped, opened;  // J
  };

  template <class T, class S>
  FURROW_HD static inline SpringLosses<T> spring_losses(const SpringStep<T>& at, S dt) {
    const T zero = constant<T>(0.0), half = constant<T>(0.5), one = constant<T>(1.0), tiny = constant<T>(kTiny);
    const T unloading = at.root / larger(at.root_before, at.root);
    const Triple<T> turned = turn_with_contact(at.before, at.normal, at.angle, unloading);
    const Triple<T> trial = turned - (at.stiffness * dt) * at.rate;
    const Triple<T> damper = (-at.viscosity) * at.rate;
    Triple<T> spring = trial;
    const Triple<T> force = cut_at_limit(spring, damper, at.limit);
    const T per_stiffness = one / at.stiffness;
    const Triple<T> slip = per_stiffness * (spring - trial);  // (5); exactly 0 while it holds
    const Triple<T> stretch = (zero + dt) * at.rate - slip;
    const T taken = half * dot(turned + spring, stretch);
    const auto slides = dot(slip, slip) > zero, bears = at.limit > zero;
    const T held = half * per_stiffness * dot(at.before, at.before);
    SpringLosses<T> out;
    out.stored = half * per_stiffness * dot(spring, spring);
    out.slid = bears ? (slides ? taken - dt * dot(force, at.rate) : zero) : zero;
    out.damped = slides ? zero : -(dt * dot(damper, at.rate));
    out.opened = held * (at.root / larger(at.root_before, tiny) - unloading * unloading) + (bears ? zero : taken);
    return out;
  }
};

}  // namespace furrow::terrain::dem
