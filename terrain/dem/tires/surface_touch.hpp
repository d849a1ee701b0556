// One grain at one touched point of a surface: how it moves there, and which earlier point hands on its history.
#pragma once

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/quad.hpp"
#include "terrain/surface/surface_collider.hpp"
#include "terrain/surface/surface_forces.hpp"

namespace furrow::terrain::dem {

inline Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Triple<double> triple(const Quad& q) { return {q.x, q.y, q.z}; }
inline Vec3 vec(const Triple<double>& t) { return {t.x, t.y, t.z}; }

/// History passes between points whose normals differ by less than 60°: the cosine of that.
inline constexpr double kSameNormal = 0.5;

/// Spin of a triangle about unit n: half the circulation of the vertex velocities over the area, rad/s.
/// @pre the surface has the triangle
double spin_about(const SurfaceCollider& surface, int triangle, const Vec3& n);

/// A touched point: where it is from the grain's centre, and how the grain moves there.
struct SurfacePoint {
  const SurfaceHit& hit;
  Triple<double> arm;  // m
  ContactMotion<double> motion;

  /// @param velocity of the centre, m/s  @param spin of the grain, rad/s
  SurfacePoint(const SurfaceCollider& surface, const SurfaceHit& at, const Vec3& centre, const Triple<double>& velocity,
               const Triple<double>& spin)
      : hit(at),
        arm(triple(Vec3(at.point - centre))),
        motion(motion_on_surface(triple(at.normal), at.overlap, arm, velocity, spin)) {
    motion.velocity = motion.velocity - triple(surface.velocity_at(at));
    motion.spin += 0.5 * spin_about(surface, at.triangle, at.normal);
  }
};

/// What a touched point gives, by its share, to the grain (N, N m) and to the surface.
struct PointLoads {
  Triple<double> force, torque;
  SurfaceContactForce on_surface;
};
/// @param tangents  the surface gets its tangent too
template <class Law>
PointLoads point_loads(const typename Law::template Coefficients<double>& c, const ContactForce<double>& f,
                       const SurfacePoint& at, bool tangents) {
  const SurfaceHit& hit = at.hit;
  const Triple<double> push = (hit.share * f.normal) * at.motion.normal, drag = hit.share * f.tangential;
  PointLoads out{push + drag,
                 cross(at.arm, push + drag) + hit.share * f.rolling,
                 {hit.triangle, hit.weight, hit.point, -vec(push), -vec(drag), {}}};
  if (tangents) {
    const ContactStiffness k = Law::tangent(c, at.motion, f, hit.share);
    out.on_surface.tangent = {hit.normal, k.k_n, k.k_t, k.c_n, k.c_t};
  }
  return out;
}

}  // namespace furrow::terrain::dem
