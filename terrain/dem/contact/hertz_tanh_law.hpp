// Law hertz_tanh: Hertz with friction regularised by tanh, the law of the 2016 SBEL report.
//   F_e = max(0, √δ (k_n δ − g_n v_n)),   F_t = μ F_e tanh(c |v_t|) against v_t; no history, no static friction     (2)
//   with the impulse limit F_t ≤ β m_t |v_t| / dt, m_t = m/7 between equal spheres, 2m/7 against a surface.        (3)
//
// Mixing: k_n, g_n arithmetic mean; μ, c_t minimum. The stiffness is given for one size of grains.
//
// Losses. The normal spring is the only one.
//   sliding −F_t·v_t,   rolling −M·ω,   normal damping (k_n δ^{3/2} − F_e) v_n, whether F_e is cut at 0 or not
#pragma once

#include <cmath>
#include <limits>

#include "terrain/dem/contact/contact.hpp"
#include "terrain/dem/contact/tanh.hpp"

namespace furrow::terrain::dem {

struct HertzTanhLaw {
  static constexpr const char* kName = "hertz_tanh";
  static constexpr const char* kStiffnessKey = "normal_stiffness";
  static constexpr bool kHistory = false, kSizes = false;

  template <class S>
  struct Coefficients {
    S stiffness{};       // k_n, N/m^1.5
    S damping{};         // g_n, N s/m^1.5
    S friction{};        // μ, -
    S cohesion_force{};  // F_c, N
    S velocity_scale{};  // c, s/m
    S slip_limit{};      // β m_t / dt, N s/m; infinite: no limit
    S rolling_arm{};     // μ_r R*, m
    S rolling_radius{};  // R*, m
    S roll_limit{};      // β I / dt, N m s; infinite: no limit
  };

  /// @pre options.step > 0 with the impulse limit
  template <class Pair, class Options>
  static Coefficients<double> mix(const Pair& pair, const Options& options) {
    const auto &a = pair.a, &b = pair.b;
    Coefficients<double> c;
    c.stiffness = 0.5 * (a.normal_stiffness + b.normal_stiffness);
    c.damping = 0.5 * (a.normal_damping + b.normal_damping);
    c.friction = pair.friction;
    c.cohesion_force = pair.cohesion_force();
    c.velocity_scale = options.friction_velocity_scale;
    c.rolling_arm = pair.rolling * pair.reduced_radius;
    c.rolling_radius = pair.reduced_radius;
    const bool limited = options.friction_impulse_limit;
    c.slip_limit = limited ? kImpulseShare * pair.slide_mass / options.step : std::numeric_limits<double>::infinity();
    c.roll_limit = limited ? kImpulseShare * pair.inertia / options.step : std::numeric_limits<double>::infinity();
    return c;
  }

  template <bool kRolling, class C, class S, class T>
  FURROW_HD static inline ContactForce<T> force(const Coefficients<C>& c, S, const ContactMotion<T>& at,
                                                ContactHistory<T>&) {
    const T zero = constant<T>(0.0), tiny = constant<T>(1e-30);
    const T s = at.root_overlap;
    const T v_n = dot(at.velocity, at.normal);
    const Triple<T> v_t = at.velocity - v_n * at.normal;

    ContactForce<T> f;
    f.elastic = larger(s * (c.stiffness * at.overlap - c.damping * v_n), zero);  // (2)
    f.normal = f.elastic - c.cohesion_force;                                     // (1)
    f.energy = (constant<T>(0.4) * c.stiffness * s * at.overlap - c.cohesion_force) * at.overlap;
    const T speed = larger(root(dot(v_t, v_t)), tiny);
    const T share = c.friction * f.elastic * tanh_of_positive(c.velocity_scale * speed) / speed;
    f.tangential = -smaller(share, zero + c.slip_limit) * v_t;  // (3)

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

  template <bool kRolling, class C, class S, class T>
  FURROW_HD static inline ContactSampleOf<T> sample(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
                                                    ContactHistory<T> history) {
    const ContactForce<T> f = force<kRolling>(c, dt, at, history);
    const T v_n = dot(at.velocity, at.normal);
    ContactSampleOf<T> out;
    out.power.normal_damping = (c.stiffness * at.root_overlap * at.overlap - f.elastic) * v_n;
    out.power.sliding = -dot(f.tangential, at.velocity);
    if constexpr (kRolling) out.power.rolling = -dot(f.rolling, at.roll);
    out.stored.cohesion = -(c.cohesion_force * at.overlap);
    return out;
  }

  FURROW_HD static inline Stored held(const Coefficients<double>& c, double overlap, const ContactHistory<double>&) {
    return {.cohesion = -(c.cohesion_force * overlap), .tangential = 0.0};
  }

  /// k_n = 3/2 k_n √δ, c_n = g_n √δ; while tanh is nearly linear, friction is a dashpot c_t = F_t/|v_t| without
  /// stiffness.
  FURROW_HD static inline ContactStiffness tangent(const Coefficients<double>& c, const ContactMotion<double>& at,
                                                   const ContactForce<double>& f, double share) {
    ContactStiffness t;
    if (!(f.elastic > 0.0)) return t;
    const double s = at.root_overlap, v_n = dot(at.velocity, at.normal);
    t.k_n = share * 1.5 * c.stiffness * s;
    t.c_n = share * c.damping * s;
    const double speed = std::sqrt(larger(0.0, dot(at.velocity, at.velocity) - v_n * v_n));
    if (c.velocity_scale * speed < kViscous)
      t.c_t = share * smaller(c.friction * f.elastic * c.velocity_scale, c.slip_limit);
    if (const double rate = c.velocity_scale * c.rolling_radius; rate * std::sqrt(dot(at.roll, at.roll)) < kViscous)
      t.c_r = share * smaller(c.rolling_arm * f.elastic * rate, c.roll_limit);
    return t;
  }

  /// The impulse limit makes friction a dashpot c_t = β m/(7 dt), which uses a part of the 4 of stable_oscillation.
  /// Without the limit, friction is a dashpot c μ F_e at small |v_t|: 7 c μ F_e dt / m < 2 between equal spheres.
  template <class Options>
  static StableStep stable_step(const Coefficients<double>& c, const Options& options, double mass, double overlap) {
    const double s = std::sqrt(overlap);
    const bool limited = options.friction_impulse_limit;
    StableStep out =
        stable_oscillation(s * stiffest_mode(1.5 * c.stiffness, 0.0, mass), s * stiffest_mode(c.damping, 0.0, mass),
                           4.0 - (limited ? 2.0 * stiffest_mode(0.0, kImpulseShare * mass / 7.0, mass) : 0.0));
    if (limited || !(c.friction > 0.0)) return out;
    const double viscous = 2.0 * mass / (7.0 * c.velocity_scale * c.friction * (c.stiffness * s * overlap));
    if (viscous < out.step) out = {viscous, "friction viscosity"};
    return out;
  }

  static double resting_force(const Coefficients<double>& c, double overlap) { return hertz_force(c, overlap); }
  static double resting_overlap(const Coefficients<double>& c, double force) { return hertz_overlap(c, force); }
  /// The modulus that gives two grains the stiffness k_n = 4/3 E* √R*, Pa.
  template <class Options>
  static double young_modulus(const Options& options) {
    return 1.5 * (1.0 - options.poisson_ratio * options.poisson_ratio) * options.normal_stiffness /
           std::sqrt(0.5 * options.radius);
  }
  /// Without the limit, friction chatters and the bed never rests.
  template <class Options>
  static bool can_rest(const Options& options) {
    return options.friction_impulse_limit;
  }
  /// Calls require(key, value, fits, expected) for the law's requirements on a surface.
  template <class Material, class Require>
  static void check(const Material& m, const Require& require) {
    require("normal_stiffness", m.normal_stiffness, m.normal_stiffness > 0.0, "above 0 N/m^1.5");
    require("normal_damping", m.normal_damping, m.normal_damping >= 0.0, "0 N s/m^1.5 or more");
  }

 private:
  static constexpr double kImpulseShare = 0.3;  // β of Eq. (3)
  static constexpr double kViscous = 0.5;       // c |v_t| below which tanh is nearly linear, like a dashpot
};

}  // namespace furrow::terrain::dem
