// The laws of contact_law.hpp taken apart: what the springs of a contact hold, and by which mechanism its energy
// leaves. All of it from what the law is given, so that it may be evaluated beside the law, or not at all.
//
// mindlin. Spring and damper are in parallel, a slider that gives way at the Coulomb limit is in series with both. Of
// the way v_t dt of a step the slider goes s, the spring is stretched by the rest e; S′ is the spring turned and
// rescaled, S what the step leaves of it, k = k_t √δ, D = −c_t δ^¼ v_t, F = S + D:
//   s = (S − S′ + k v_t dt)/k,   e = v_t dt − s                                                                   (1)
//   sliding              −F·v_t dt + ½ (S′ + S)·e while it slides: friction's work, less what the spring takes of it
//   tangential damping   −D·v_t dt while it holds
//   opening              |S_old|²/2k_old − |S′|²/2k ≥ 0: what the spring gives up as the normal load changes, by
//                        rescaling on unloading and by k on loading; ½ (S′ + S)·e while the contact pulls and so bears
//                        no friction; and all that the spring still holds where the contact ends
//   normal damping       c_n δ^¼ v_n²
// A contact that parts always pulls in the end, F_e < 0. The law then sets S = −D: the spring takes up what no force
// gave, and the end of the contact gives it up. Both are opening, and cancel.
// Rolling resistance is the same for torque and relative spin; all that its parts lose is one mechanism, rolling.
//
// hertz_tanh has no springs but the normal one.
//   sliding −F_t·v_t,   rolling −M·ω,   normal damping (k_n δ^{3/2} − F_e) v_n, whether F_e is cut at 0 or not
//
// Cohesion is a potential: −F_c δ is what a contact's constant pull stores, nothing is lost when it opens.
#pragma once

#include "protocol/core/fields.hpp"
#include "terrain/dem/contact_law.hpp"

namespace furrow::terrain::dem {

/// By mechanism: energy lost, J, or its rate, W.
template <class T>
struct LossesOf {
  T sliding{}, normal_damping{}, tangential_damping{}, rolling{}, opening{};
};
using Losses = LossesOf<double>;
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<Losses> auto& s) {
  visit(Field{"sliding", ""}, s.sliding);
  visit(Field{"normal_damping", ""}, s.normal_damping);
  visit(Field{"tangential_damping", ""}, s.tangential_damping);
  visit(Field{"rolling", ""}, s.rolling);
  visit(Field{"opening", ""}, s.opening);
}
inline double total(const Losses& l) {
  return l.sliding + l.normal_damping + l.tangential_damping + l.rolling + l.opening;
}
inline void add(Losses& to, const Losses& l, double times) {
  to.sliding += times * l.sliding;
  to.normal_damping += times * l.normal_damping;
  to.tangential_damping += times * l.tangential_damping;
  to.rolling += times * l.rolling;
  to.opening += times * l.opening;
}

/// What contacts store beside their normal springs, J.
template <class T>
struct StoredOf {
  T cohesion{};    // Σ −F_c δ
  T tangential{};  // tangential and rolling springs
};
using Stored = StoredOf<double>;
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<Stored> auto& s) {
  visit(Field{"cohesion", "J"}, s.cohesion);
  visit(Field{"tangential", "J"}, s.tangential);
}
inline void add(Stored& to, const Stored& s, double times) {
  to.cohesion += times * s.cohesion;
  to.tangential += times * s.tangential;
}

/// Of one contact, or of several, in one evaluation.
template <class T>
struct ContactSampleOf {
  LossesOf<T> power;   // W
  StoredOf<T> stored;  // after it
};
using ContactSample = ContactSampleOf<double>;
inline void add(ContactSample& to, const ContactSample& s, double times = 1.0) {
  add(to.power, s.power, times);
  add(to.stored, s.stored, times);
}

namespace detail {

/// One of the two springs of law mindlin, with its damper and slider, in one evaluation.
template <class T>
struct SpringStep {
  Triple<T> before;     // its force when last evaluated
  T root_before, root;  // √δ then and now, √m
  Triple<T> normal;
  T angle;         // by which the contact turned about its normal
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
inline SpringLosses<T> spring_losses(const SpringStep<T>& at, S dt) {
  const T zero = constant<T>(0.0), half = constant<T>(0.5), one = constant<T>(1.0), tiny = constant<T>(kTiny);
  const T unloading = at.root / larger(at.root_before, at.root);
  const Triple<T> turned = turn_with_contact(at.before, at.normal, at.angle, unloading);
  const Triple<T> trial = turned - (at.stiffness * dt) * at.rate;
  const Triple<T> damper = (-at.viscosity) * at.rate;
  Triple<T> spring = trial;
  const Triple<T> force = cut_at_limit(spring, damper, at.limit);
  const T per_stiffness = one / at.stiffness;
  const Triple<T> slip = per_stiffness * (spring - trial);  // (1); exactly 0 while it holds
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

}  // namespace detail

/// @param history as it was before the law was evaluated for the same motion and dt
template <class Law, bool kRolling, class C, class S, class T>
requires Law::kHistory inline ContactSampleOf<T> contact_sample(const Coefficients<C>& c, S dt,
                                                                const ContactMotion<T>& at,
                                                                const ContactHistory<T>& history) {
  const T zero = constant<T>(0.0), per_step = constant<T>(1.0) / (zero + dt);
  const T s = at.root_overlap, q = root(s);
  const T v_n = dot(at.velocity, at.normal);
  const T bearing = larger(c.stiffness * s * at.overlap - c.damping * q * v_n, zero);
  ContactSampleOf<T> out;
  out.power.normal_damping = c.damping * q * v_n * v_n;
  out.stored.cohesion = -(c.cohesion_force * at.overlap);
  const auto spring = [&](const Triple<T>& before, T stiffness, T viscosity, const Triple<T>& rate, T limit) {
    return detail::spring_losses<T>({.before = before,
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
  // Without friction there is no spring, though the law's history holds what its damper was cut by.
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

template <class Law, bool kRolling, class C, class S, class T>
requires(!Law::kHistory) inline ContactSampleOf<T> contact_sample(const Coefficients<C>& c, S dt,
                                                                  const ContactMotion<T>& at,
                                                                  ContactHistory<T> history) {
  const ContactForce<T> f = Law::template force<kRolling>(c, dt, at, history);
  const T v_n = dot(at.velocity, at.normal);
  ContactSampleOf<T> out;
  out.power.normal_damping = (c.stiffness * at.root_overlap * at.overlap - f.elastic) * v_n;
  out.power.sliding = -dot(f.tangential, at.velocity);
  if constexpr (kRolling) out.power.rolling = -dot(f.rolling, at.roll);
  out.stored.cohesion = -(c.cohesion_force * at.overlap);
  return out;
}

/// What the tangential and rolling springs of a contact of law mindlin hold when `root_overlap` is √δ, J.
inline double held_by_springs(const ContactCoefficients& c, const Triple<double>& tangential, double root_overlap,
                              const Triple<double>& rolling) {
  if (!(root_overlap > 0.0) || !(c.shear_stiffness > 0.0)) return 0.0;
  const double k = c.shear_stiffness * root_overlap, r2 = c.rolling_radius * c.rolling_radius;
  double held = 0.0;
  if (c.friction > 0.0) held += 0.5 * dot(tangential, tangential) / k;
  if (c.rolling_arm > 0.0) held += 0.5 * dot(rolling, rolling) / (k * r2);
  return held;
}

/// contact_sample() out of line, so that the code of the law beside it, and with it every bit of the motion, is the
/// same whether samples are taken or not.
template <class Law, bool kRolling>
[[gnu::noinline]] ContactSample sample_of(const ContactCoefficients& c, double dt, const ContactMotion<double>& at,
                                          const ContactHistory<double>& history) {
  return contact_sample<Law, kRolling>(c, dt, at, history);
}

}  // namespace furrow::terrain::dem
