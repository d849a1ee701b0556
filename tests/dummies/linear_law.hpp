// Dummy of a contact law: a linear spring and dashpot along the normal, friction without memory.
//   F_e = max(0, k δ − c v_n),   F_t = min(μ F_e / |v_t|, c) against v_t
#pragma once

#include <cmath>

#include "terrain/dem/contact/contact.hpp"

namespace furrow::terrain::dem {

struct LinearLaw {
  static constexpr const char* kName = "linear";
  static constexpr const char* kStiffnessKey = "normal_stiffness";
  static constexpr bool kHistory = false, kSizes = false;

  template <class S>
  struct Coefficients {
    S stiffness{};       // k, N/m
    S damping{};         // c, N s/m
    S friction{};        // μ, -
    S cohesion_force{};  // F_c, N
    S rolling_arm{};     // μ_r R*, m
    S rolling_radius{};  // R*, m
  };

  template <class Pair, class Options>
  static Coefficients<double> mix(const Pair& pair, const Options&) {
    Coefficients<double> c;
    c.stiffness = 0.5 * (pair.a.normal_stiffness + pair.b.normal_stiffness);
    c.damping = 0.5 * (pair.a.normal_damping + pair.b.normal_damping);
    c.friction = pair.friction;
    c.cohesion_force = pair.cohesion_force();
    c.rolling_arm = pair.rolling * pair.reduced_radius;
    c.rolling_radius = pair.reduced_radius;
    return c;
  }

  template <bool kRolling, class C, class S, class T>
  static inline ContactForce<T> force(const Coefficients<C>& c, S, const ContactMotion<T>& at, ContactHistory<T>&) {
    const T zero = constant<T>(0.0), tiny = constant<T>(1e-30);
    const T v_n = dot(at.velocity, at.normal);
    const Triple<T> v_t = at.velocity - v_n * at.normal;
    ContactForce<T> f;
    f.elastic = larger(c.stiffness * at.overlap - c.damping * v_n, zero);
    f.normal = f.elastic - c.cohesion_force;
    f.energy = (constant<T>(0.5) * c.stiffness * at.overlap - c.cohesion_force) * at.overlap;
    const auto brake = [&](const Triple<T>& rate, T limit, T dashpot) {
      return -smaller(limit / larger(root(dot(rate, rate)), tiny), dashpot) * rate;
    };
    f.tangential = brake(v_t, c.friction * f.elastic, zero + c.damping);
    f.rolling = {zero, zero, zero};
    if constexpr (kRolling) {
      const Triple<T> w = at.roll - dot(at.roll, at.normal) * at.normal;
      f.rolling = brake(w, c.rolling_arm * f.elastic, zero + c.damping * c.rolling_radius * c.rolling_radius);
    }
    return f;
  }

  template <bool kRolling, class C, class S, class T>
  static inline ContactSampleOf<T> sample(const Coefficients<C>& c, S dt, const ContactMotion<T>& at,
                                          ContactHistory<T> history) {
    const ContactForce<T> f = force<kRolling>(c, dt, at, history);
    ContactSampleOf<T> out;
    out.power.normal_damping = (c.stiffness * at.overlap - f.elastic) * dot(at.velocity, at.normal);
    out.power.sliding = -dot(f.tangential, at.velocity);
    if constexpr (kRolling) out.power.rolling = -dot(f.rolling, at.roll);
    out.stored.cohesion = -(c.cohesion_force * at.overlap);
    return out;
  }

  static inline Stored held(const Coefficients<double>& c, double overlap, const ContactHistory<double>&) {
    return {.cohesion = -(c.cohesion_force * overlap), .tangential = 0.0};
  }

  static inline ContactStiffness tangent(const Coefficients<double>& c, const ContactMotion<double>&,
                                         const ContactForce<double>& f, double share) {
    if (!(f.elastic > 0.0)) return {};
    return {.k_n = share * c.stiffness, .k_t = 0.0, .c_n = share * c.damping, .c_t = share * c.damping};
  }

  template <class Options>
  static StableStep stable_step(const Coefficients<double>& c, const Options&, double mass, double) {
    return stable_oscillation(stiffest_mode(c.stiffness, 0.0, mass), stiffest_mode(c.damping, c.damping, mass), 4.0);
  }

  static double resting_force(const Coefficients<double>& c, double overlap) {
    return larger(0.0, c.stiffness * overlap - c.cohesion_force);
  }
  static double resting_overlap(const Coefficients<double>& c, double force) {
    return (force + c.cohesion_force) / c.stiffness;
  }
  template <class Options>
  static double young_modulus(const Options& options) {
    return options.normal_stiffness / options.radius;
  }
  template <class Options>
  static bool can_rest(const Options&) {
    return true;
  }
  template <class Material, class Require>
  static void check(const Material& m, const Require& require) {
    require("normal_stiffness", m.normal_stiffness, m.normal_stiffness > 0.0, "above 0 N/m");
    require("normal_damping", m.normal_damping, m.normal_damping >= 0.0, "0 N s/m or more");
  }
};

}  // namespace furrow::terrain::dem
