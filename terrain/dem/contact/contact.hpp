// One contact, and the interface of contact laws; the same for grain–grain, grain–wall and grain–tire contacts.
//
// A contact has a unit normal n that pushes grain i, overlap δ > 0, and one common point at which the relative
// velocity v of i against its partner is taken; v_n = v·n > 0 separating, v_t = v − v_n n.
//
// Normal force of every law, with F_c = π r² c_t constant while in contact
// [Recuero et al. 2016, Wheeled vehicle mobility studies in Chrono, SBEL technical report]:
//   F_n = F_e − F_c,   Coulomb limit μ max(F_e, 0): cohesion gives shear strength.                               (1)
//
// A law is a struct of static functions in its own file, and one line of laws.hpp. All other code uses these members:
//   kName                                    name of the law in terrain.law
//   kStiffnessKey                            key of DemOptions to which forces at a given overlap are proportional
//   kHistory                                 the contact stores springs: static friction, beds that come to rest
//   kSizes                                   grains may differ in size; then scaled(c, SizeScale<T>)
//   Coefficients<S>                          only numbers S, for one kind of partner
//   mix(pair, options)                       Coefficients<double> of a MixedPair (contact_mixing.hpp), DemOptions
//   force<kRolling>(c, dt, motion, history)  ContactForce; updates the history
//   sample<kRolling>(…)                      ContactSample: losses and springs, from the history before the step
//   held(c, overlap, history)                Stored, if nothing moves
//   tangent(c, motion, force, share)         ContactStiffness of `share` of the contact, for a grain that does not move
//   stable_step(c, options, mass, overlap)   StableStep of a bed of these contacts
//   resting_force(c, δ), resting_overlap(c, F)  F = F_n if nothing moves
//   young_modulus(options)                   of the grains, Pa
//   can_rest(options)                        whether a bed comes to rest, so that its grains may sleep
//   check(material, require)                 checks the material of a surface
// Functions of the law itself are plain code of one number type T (float, double or a register of simd.hpp), without
// containers or virtual calls. C, the type of the coefficients' numbers, is a scalar, or T with one value per contact.
#pragma once

#include <cmath>

#include "protocol/core/triple.hpp"
#include "terrain/dem/accounts/contact_losses.hpp"

namespace furrow::terrain::dem {

using namespace simd;

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
  T root_overlap;        // √δ of the previous step, √m
  Triple<T> rolling;     // spring part of the rolling torque on grain i, N m
};

template <class T>
struct ContactForce {
  T normal;              // F_n, N, positive pushes
  T elastic;             // F_e, N
  Triple<T> tangential;  // F_t on grain i, N
  Triple<T> rolling;     // rolling torque on grain i, N m (the partner gets the opposite)
  T energy;              // stored in the normal spring and by cohesion, J
};

/// How the force on the partner responds to the partner's motion, as in SurfaceContactTangent.
struct ContactStiffness {
  double k_n = 0.0, k_t = 0.0;  // N/m
  double c_n = 0.0, c_t = 0.0;  // N s/m
  double k_r = 0.0, c_r = 0.0;  // of the rolling couple, N m, N m s
};

/// Largest stable step of semi-implicit Euler, and its limit.
struct StableStep {
  double step = 0.0;               // s
  const char* reason = "unknown";  // "stiffness", "damping", "friction viscosity"
};

/// Rate of work of the contact on the grains, W; its rolling torque adds rolling·roll.
template <class T>
FURROW_HD inline T power_of(const ContactForce<T>& f, const ContactMotion<T>& at) {
  return f.normal * dot(at.velocity, at.normal) + dot(f.tangential, at.velocity);
}

// ---- parts that laws share --------------------------------------------------------------------------------------

/// Smaller squares count as zero; a float can still represent it.
inline constexpr double kTiny = 1e-35;

/// Turns a vector in the contact plane with the contact (spin about n, projection, same length) and scales it.
template <class T>
FURROW_HD inline Triple<T> turn_with_contact(const Triple<T>& old, const Triple<T>& n, T spin_angle, T scale) {
  const Triple<T> spun = old + spin_angle * cross(n, old);
  const Triple<T> flat = spun - dot(spun, n) * n;
  const T before = dot(old, old), after = dot(flat, flat);
  const T tiny = constant<T>(kTiny);
  return (scale * root(before / larger(after, tiny))) * flat;
}

/// Cuts spring + damper at `limit`; the spring keeps limit − damper. Returns the sum.
template <class T>
FURROW_HD inline Triple<T> cut_at_limit(Triple<T>& spring, const Triple<T>& damper, T limit) {
  const Triple<T> sum = spring + damper;
  const T square = dot(sum, sum);
  const auto over = square > limit * limit;
  const T factor = over ? limit / root(larger(square, constant<T>(kTiny))) : constant<T>(1.0);
  const Triple<T> cut = factor * sum;
  spring = {over ? cut.x - damper.x : spring.x, over ? cut.y - damper.y : spring.y, over ? cut.z - damper.z : spring.z};
  return cut;
}

/// Hertz's F_e = K δ^{3/2} at rest, less cohesion, and its inverse.
template <class C>
double hertz_force(const C& c, double overlap) {
  return larger(0.0, c.stiffness * std::pow(overlap, 1.5) - c.cohesion_force);
}
template <class C>
double hertz_overlap(const C& c, double force) {
  return std::pow((force + c.cohesion_force) / c.stiffness, 2.0 / 3.0);
}

/// ω² of the stiffest mode of a bed of z = 6 contacts per grain in random directions, or γ of its dashpots. With Σ n nᵀ
/// = z/3 I and neighbours in antiphase the stiffest modes of translation and of rotation (I = 2/5 m r²) are
///   ω² = 2 z/3 (k_n + 2 k_t)/m   and   ω² = 2 z (2/3) (5/2) k_t/m,     and γ in the same way with the dashpots;
/// the larger of the two is taken.
inline double stiffest_mode(double normal, double shear, double mass) {
  constexpr double kContacts = 6.0;
  return 2.0 * kContacts / 3.0 / mass * larger(normal + 2.0 * shear, 5.0 * shear);
}

/// v ← v − dt (γ v + ω² x), x ← x + dt v is stable for ω² dt² + 2 γ dt < room, 4 if nothing else takes a part of it.
inline StableStep stable_oscillation(double omega2, double gamma, double room) {
  return {(std::sqrt(gamma * gamma + room * omega2) - gamma) / omega2,
          gamma * gamma > omega2 ? "damping" : "stiffness"};
}

/// Calls sample() without inlining, so that the code of the law, and with it every bit of the motion, is the same with
/// and without samples.
template <class Law, bool kRolling>
[[gnu::noinline]] ContactSample sample_of(const typename Law::template Coefficients<double>& c, double dt,
                                          const ContactMotion<double>& at, const ContactHistory<double>& history) {
  return Law::template sample<kRolling>(c, dt, at, history);
}

}  // namespace furrow::terrain::dem
