// One grain at one touched point of a surface: its motion there, and which earlier point passes on its history.
#pragma once

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/quad.hpp"
#include "terrain/surface/surface_collider.hpp"
#include "terrain/surface/surface_forces.hpp"
#include "terrain/surface/surface_vectors.hpp"

namespace furrow::terrain::dem {

using terrain::triple;
using terrain::vec;
inline Triple<double> triple(const Quad& q) { return {q.x, q.y, q.z}; }

/// Cosine of 60°: history passes between points whose normals differ by less.
inline constexpr double kSameNormal = 0.5;

/// Spin of a triangle about unit n: half the circulation of the vertex velocities over the area, rad/s.
/// @pre the surface has the triangle
double spin_about(const SurfaceCollider& surface, int triangle, const Vec3& n);

/// @param patch around the point, for the roll of the grain against it; null if nothing resists rolling
/// @param arm from the grain's centre to the point, m  @param velocity of the centre, m/s  @param spin rad/s
inline ContactMotion<double> motion_at(const SurfaceCollider& surface, const PatchTurn* patch, const SurfaceHit& hit,
                                       const Triple<double>& arm, const Triple<double>& velocity,
                                       const Triple<double>& spin) {
  ContactMotion<double> motion = motion_on_surface(triple(hit.normal), hit.overlap, arm, velocity, spin);
  motion.velocity = motion.velocity - triple(surface.velocity_at(hit));
  motion.spin += 0.5 * spin_about(surface, hit.triangle, hit.normal);
  if (patch) motion.roll = motion.roll - triple(patch->spin(surface.velocities()));
  return motion;
}

/// Whether friction is within 1 % of its limit.
template <class Coefficients>
bool slides(const Coefficients& c, const ContactForce<double>& f) {
  const double limit = 0.99 * c.friction * f.elastic;
  return dot(f.tangential, f.tangential) >= limit * limit;
}

/// How a contact that counts by `share` responds to the motion of the surface.
template <class Law>
SurfaceContactTangent contact_tangent(const typename Law::template Coefficients<double>& c,
                                      const ContactMotion<double>& at, const ContactForce<double>& f, double share) {
  const ContactStiffness k = Law::tangent(c, at, f, share);
  return {vec(at.normal), k.k_n, k.k_t, k.c_n, k.c_t, k.k_r, k.c_r};
}

}  // namespace furrow::terrain::dem
