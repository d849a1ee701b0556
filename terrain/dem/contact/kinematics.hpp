// Relative motion of two bodies at their contact, and the loads of the contact's force on them: grain with grain, grain
// with wall, grain with a facet of a tire. Each formula is here once, for every law, engine and number type.
#pragma once

#include "terrain/dem/contact/contact.hpp"

namespace furrow::terrain::dem {

// ---- grain i with grain j --------------------------------------------------------------------------------------
//
// With d = x_i − x_j the arms r − δ/2 are ±d/2, so v = v_i − v_j − ½ (ω_i + ω_j) × d, and the torque on i and on j is
// −½ d × F_t. Grains of different sizes have the arms r_i − δ/2 = ½ (|d| + Δ) and ½ (|d| − Δ), Δ = r_i − r_j. Then v
// gains −½ Δ (ω_i − ω_j) × n, and the couple ∓½ Δ n × F_t is added to that of rolling resistance. δ = D − |d| would
// lose digits; with D = r_i + r_j it is computed as (D² − d²)/(D + |d|).

/// Sets normal and overlap. @param gap D² − d² > 0, m²  @param sum D, m
template <class T>
[[gnu::always_inline]] FURROW_HD inline void set_pair_overlap(ContactMotion<T>& to, const Triple<T>& d, T gap, T sum) {
  const T distance = root(dot(d, d));
  to.normal = (constant<T>(1.0) / distance) * d;
  to.overlap = gap / (sum + distance);
  to.root_overlap = root(to.overlap);
}

/// Motion of grain i relative to grain j.
template <class T>
struct RelativeMotion {
  Triple<T> dv;    // v_i − v_j, m/s
  Triple<T> turn;  // ω_i + ω_j, rad/s
  Triple<T> roll;  // ω_i − ω_j, rad/s; with rolling resistance or sizes
  T delta;         // Δ, m; with sizes
};

/// Sets velocity and spin. @pre the normal is set
template <bool kSizes, class T>
[[gnu::always_inline]] FURROW_HD inline void set_pair_velocity(ContactMotion<T>& to, const Triple<T>& d,
                                                               const RelativeMotion<T>& relative) {
  const T half = constant<T>(0.5);
  to.velocity = relative.dv - half * cross(relative.turn, d);
  if constexpr (kSizes) to.velocity = to.velocity - (half * relative.delta) * cross(relative.roll, to.normal);
  to.spin = half * dot(relative.turn, to.normal);
}

/// Loads on grain i: force, torque and couple are F, t and q; on grain j −F, t and −q.
template <class T>
struct PairLoads {
  Triple<T> force, torque, couple;  // N, N m
};

/// @param delta Δ, m, with sizes
template <bool kSizes, class T>
[[gnu::always_inline]] FURROW_HD inline PairLoads<T> pair_loads(const ContactForce<T>& f, const Triple<T>& normal,
                                                                const Triple<T>& d, T delta) {
  const T half = constant<T>(0.5);
  PairLoads<T> out{f.normal * normal + f.tangential, -half * cross(d, f.tangential), f.rolling};
  if constexpr (kSizes) out.couple = out.couple - (half * delta) * cross(normal, f.tangential);
  return out;
}

// ---- a grain with a surface, at a point of the surface ---------------------------------------------------------

/// Sets the motion against a surface at rest. @param arm from the grain's centre to the point, m  @param v, w of the
/// grain, m/s, rad/s
template <class T>
[[gnu::always_inline]] FURROW_HD inline ContactMotion<T> motion_on_surface(const Triple<T>& normal, T overlap,
                                                                           const Triple<T>& arm, const Triple<T>& v,
                                                                           const Triple<T>& w) {
  return {normal, overlap, root(overlap), v + cross(w, arm), constant<T>(0.5) * dot(w, normal), w};
}

/// A grain on a wall of the bin. The point is the projection of the centre on the wall's plane, arm −distance n.
template <class T>
struct WallPoint {
  Triple<T> arm;  // m
  ContactMotion<T> motion;
};
/// @param distance of the wall from the centre, m
template <class T>
[[gnu::always_inline]] FURROW_HD inline WallPoint<T> point_on_wall(const Triple<T>& normal, T distance, T overlap,
                                                                   const Triple<T>& v, const Triple<T>& w) {
  const Triple<T> arm = (-distance) * normal;
  return {arm, motion_on_surface(normal, overlap, arm, v, w)};
}

template <class T>
struct SurfaceLoads {
  Triple<T> force, torque;  // N, N m
};
template <class T>
[[gnu::always_inline]] FURROW_HD inline SurfaceLoads<T> wall_loads(const ContactForce<T>& f, const WallPoint<T>& at) {
  return {f.normal * at.motion.normal + f.tangential, cross(at.arm, f.tangential) + f.rolling};
}

/// Loads at a point of a tire's facet that counts by `share`; on the tire −push and −drag.
template <class T>
struct FacetLoads {
  Triple<T> push, drag, torque;  // N, N, N m
};
template <class T>
[[gnu::always_inline]] FURROW_HD inline FacetLoads<T> facet_loads(const ContactForce<T>& f, const Triple<T>& normal,
                                                                  const Triple<T>& arm, T share) {
  const Triple<T> push = (share * f.normal) * normal, drag = share * f.tangential;
  return {push, drag, cross(arm, push + drag) + share * f.rolling};
}

}  // namespace furrow::terrain::dem
