// One grain at one touched point of a surface: how it moves there, and which earlier point hands on its history.
#pragma once

#include <cmath>

#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/quad.hpp"
#include "terrain/surface/surface_collider.hpp"

namespace furrow::terrain::dem {

inline Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Triple<double> triple(const Quad& q) { return {q.x, q.y, q.z}; }
inline Vec3 vec(const Triple<double>& t) { return {t.x, t.y, t.z}; }

/// History passes between points whose normals differ by less than 60°: the cosine of that.
inline constexpr double kSameNormal = 0.5;

/// Spin of a triangle about unit n: half the circulation of the vertex velocities over the area, rad/s.
/// @pre the surface has the triangle
double spin_about(const SurfaceCollider& surface, int triangle, const Vec3& n);

/// @param arm from the grain's centre to the point, m  @param velocity of the centre, m/s  @param spin rad/s
inline ContactMotion<double> motion_at(const SurfaceCollider& surface, const SurfaceHit& hit, const Triple<double>& arm,
                                       const Triple<double>& velocity, const Triple<double>& spin) {
  ContactMotion<double> motion;
  motion.normal = triple(hit.normal);
  motion.overlap = hit.overlap;
  motion.root_overlap = std::sqrt(hit.overlap);
  motion.velocity = velocity + cross(spin, arm) - triple(surface.velocity_at(hit));
  motion.spin = 0.5 * (dot(spin, motion.normal) + spin_about(surface, hit.triangle, hit.normal));
  motion.roll = spin;
  return motion;
}

}  // namespace furrow::terrain::dem
