// The contact laws of grains: one function per law, used for grain–grain, grain–wall and grain–tire alike.
//
// A contact has a unit normal n that pushes grain i, overlap δ > 0, and one common point at which the relative
// velocity v of i against its partner is taken; v_n = v·n > 0 separating, v_t = v − v_n n.
//
// Normal, both laws, with F_c = π r² c_t constant while in contact
// [Recuero et al. 2016, Wheeled vehicle mobility studies in Chrono, SBEL technical report]:
//   F_n = F_e − F_c,   Coulomb limit μ max(F_e, 0): cohesion gives shear strength.                               (1)
//
// mindlin: Hertz–Mindlin
//   F_e = K δ^{3/2} − c_n δ^{1/4} v_n,     K = 4/3 E* √R*,   c_n δ^{1/4} = 2 √(5/6) β √(2 E* √(R*δ) m*)           (2)
//   β = −ln e / √(ln²e + π²), β = 1 for e = 0 [Antypov & Elliott 2011, doi:10.1209/0295-5075/94/50004]
//   dF_t = −8 G* √(R*δ) v_t dt, turned with the normal and with the mean spin about it, rescaled by √(δ/δ_old) on
//   unloading [Thornton, Cummins & Cleary 2013, doi:10.1016/j.powtec.2012.08.012]; damping as in (2) with 8 G* for
//   2 E* and 2/7 m* for m*, the mass with which a sphere's surface resists sliding                                (3)
//   the sum of spring and damper is cut at the Coulomb limit and the spring keeps what is left.
//   Rolling resistance: elastic–plastic spring–dashpot, k_r = k_t R*², cut at μ_r R* F_e
//   [Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030]                                                            (4)
//
// hertz_tanh: Hertz with friction regularised by tanh, the law of the report
//   F_e = max(0, √δ (k_n δ − g_n v_n)),   F_t = μ F_e tanh(c |v_t|) against v_t; no history, no static friction     (5)
//   with the impulse limit F_t ≤ β m_t |v_t| / dt, m_t = m/7 between equal spheres, 2m/7 against a surface.        (6)
#pragma once

#include "terrain/dem/quad.hpp"
#include "terrain/dem/tanh.hpp"

namespace furrow::terrain::dem {

/// Coefficients of one kind of partner (grain, wall, tire), already mixed.
template <class S>
struct Coefficients {
  S stiffness{};        // K or k_n, N/m^1.5
  S damping{};          // mindlin: c_n, N s/m^1.25; hertz_tanh: g_n, N s/m^1.5
  S shear_stiffness{};  // 8 G* √R*, N/m^1.5
  S shear_damping{};    // N s/m^1.25
  S friction{};         // μ, -
  S cohesion_force{};   // F_c, N
  S velocity_scale{};   // c, s/m
  S slip_limit{};       // β m_t / dt, N s/m; infinite: no limit
  S rolling_arm{};      // μ_r R*, m
  S rolling_radius{};   // R*, m
  S rolling_damping{};  // N m s/m^0.25
  S roll_limit{};       // β I / dt, N m s, law hertz_tanh; infinite: no limit
};
using ContactCoefficients = Coefficients<double>;

/// The same coefficients as another scalar type.
template <class S>
Coefficients<S> rounded(const ContactCoefficients& c) {
  Coefficients<S> out;
  out.stiffness = static_cast<S>(c.stiffness);
  out.damping = static_cast<S>(c.damping);
  out.shear_stiffness = static_cast<S>(c.shear_stiffness);
  out.shear_damping = static_cast<S>(c.shear_damping);
  out.friction = static_cast<S>(c.friction);
  out.cohesion_force = static_cast<S>(c.cohesion_force);
  out.velocity_scale = static_cast<S>(c.velocity_scale);
  out.slip_limit = static_cast<S>(c.slip_limit);
  out.rolling_arm = static_cast<S>(c.rolling_arm);
  out.rolling_radius = static_cast<S>(c.rolling_radius);
  out.rolling_damping = static_cast<S>(c.rolling_damping);
  out.roll_limit = static_cast<S>(c.roll_limit);
  return out;
}

/// Share of critical damping in the rolling spring [Ai et al. 2011, §4.2].
inline constexpr double kRollingDampingRatio = 0.3;

template <class T>
struct ContactMotion {
  Triple<T> normal;    // n, unit, pushes grain i
  T overlap;           // δ > 0, m
  T root_overlap;      // √δ, √m
  Triple<T> velocity;  // of i relative to its partner at the common point, m/s
  T spin;              // mean spin of both about n, rad/s
  Triple<T> roll;      // ω_i − ω_partner, rad/s; read only with rolling resistance
};

template <class T>
struct ContactHistory {
  Triple<T> tangential;  // spring part of F_t on grain i, N
  T root_overlap;        // √δ of the step before, √m
  Triple<T> rolling;     // spring part of the rolling torque on grain i, N m
};

template <class T>
struct ContactForce {
  T normal;              // F_n, N, positive pushes
  T elastic;             // F_e, N
  Triple<T> tangential;  // F_t on grain i, N
  Triple<T> rolling;     // rolling torque on grain i, N m (the partner gets the opposite)
  T energy;              // 2/5 K δ^{5/2} − F_c δ, J: what the normal spring and cohesion store
};

/// Squares below it count as zero; a float still holds it.
inline constexpr double kTiny = 1e-35;

/// Turns a vector held in the contact plane with the contact — spin about n, projection on the new plane, same length —
/// and scales it.
template <class T>
inline Triple<T> turn_with_contact(const Triple<T>& old, const Triple<T>& n, T spin_angle, T scale) {
  const Triple<T> spun = old + spin_angle * cross(n, old);
  const Triple<T> flat = spun - dot(spun, n) * n;
  const T before = dot(old, old), after = dot(flat, flat);
  const T tiny = constant<T>(kTiny);
  return (scale * root(before / larger(after, tiny))) * flat;
}

/// Cuts spring + damper at `limit`; the spring keeps limit − damper. Returns the sum.
template <class T>
inline Triple<T> cut_at_limit(Triple<T>& spring, const Triple<T>& damper, T limit) {
  const Triple<T> sum = spring + damper;
  const T square = dot(sum, sum);
  const auto over = square > limit * limit;
  const T factor = over ? limit / root(larger(square, constant<T>(kTiny))) : constant<T>(1.0);
  const Triple<T> cut = factor * sum;
  spring = {over ? cut.x - damper.x : spring.x, over ? cut.y - damper.y : spring.y, over ? cut.z - damper.z : spring.z};
  return cut;
}

struct MindlinLaw {
  static constexpr bool kHistory = true;

  /// C: scalar, or lanes of one coefficient per contact.
  template <bool kRolling, class C, class S, class T>
  static inline ContactForce<T> force(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
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
};

struct HertzTanhLaw {
  static constexpr bool kHistory = false;

  template <bool kRolling, class C, class S, class T>
  static inline ContactForce<T> force(const Coefficients<C>& c, S, const ContactMotion<T>& at, ContactHistory<T>&) {
    const T zero = constant<T>(0.0), tiny = constant<T>(1e-30);
    const T s = at.root_overlap;
    const T v_n = dot(at.velocity, at.normal);
    const Triple<T> v_t = at.velocity - v_n * at.normal;

    ContactForce<T> f;
    f.elastic = larger(s * (c.stiffness * at.overlap - c.damping * v_n), zero);  // (5)
    f.normal = f.elastic - c.cohesion_force;
    f.energy = (constant<T>(0.4) * c.stiffness * s * at.overlap - c.cohesion_force) * at.overlap;
    const T speed = larger(root(dot(v_t, v_t)), tiny);
    const T share = c.friction * f.elastic * tanh_of_positive(c.velocity_scale * speed) / speed;
    f.tangential = -smaller(share, zero + c.slip_limit) * v_t;  // (6)

    if constexpr (kRolling) {
      const Triple<T> w = at.roll - dot(at.roll, at.normal) * at.normal;
      const T rate = larger(root(dot(w, w)), tiny);
      const T brake = c.rolling_arm * f.elastic * tanh_of_positive(c.velocity_scale * c.rolling_radius * rate) / rate;
      f.rolling = -smaller(brake, zero + c.roll_limit) * w;
    } else {
      f.rolling = {zero, zero, zero};
    }
    return f;
  }
};

/// Rate of work of the contact on the grains, W; its rolling torque adds rolling·roll.
template <class T>
inline T power_of(const ContactForce<T>& f, const ContactMotion<T>& at) {
  return f.normal * dot(at.velocity, at.normal) + dot(f.tangential, at.velocity);
}

}  // namespace furrow::terrain::dem
