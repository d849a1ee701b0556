// Contact between spheres and a moving triangulated surface (a tire): finds the points of the surface that a grain
// touches, how deep, and the share of the contact law that each of them carries (facets.hpp).
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "protocol/core/surface.hpp"
#include "terrain/surface/facets.hpp"

namespace furrow::terrain {

/// One touched point of the surface. Force on the grain = share · law(overlap, normal, relative velocity),
/// torque on the grain = (point − centre) × force, and the opposite force on the triangle's vertices by `weight`.
struct SurfaceHit {
  Vec3 point = Vec3::Zero();   // on the surface, m, W
  Vec3 normal = Vec3::Zero();  // unit, from the surface towards the outside (the grain), W
  double overlap = 0.0;        // δ̂ > 0 of facets.hpp, Eq. (2), m
  double share = 1.0;          // s of Eq. (2), in (0, 1]
  int triangle = -1;
  std::array<double, 3> weight{};  // barycentric: point = Σ weight · vertex, Σ weight = 1, each ≥ 0
};

/// Axis-aligned box, m.
struct SurfaceBox {
  Vec3 lo = Vec3::Zero();
  Vec3 hi = Vec3::Zero();
};

class SurfaceCollider {
 public:
  /// `reach`: the largest grain radius that hits() will be called with, m.
  /// @throws Error(bad_input) on an index outside the mesh or a reach that is not positive.
  SurfaceCollider(const SurfaceMesh& mesh, double reach);
  ~SurfaceCollider();
  SurfaceCollider(SurfaceCollider&&) noexcept;
  SurfaceCollider& operator=(SurfaceCollider&&) noexcept;

  /// Declares the motion of the coming interval of `duration` (> 0), s: each vertex moves linearly from `start` to
  /// `end` (lengths = vertex_count). Afterwards the surface is at `start`.
  void set_motion(std::span<const Vec3> start, std::span<const Vec3> end, double duration);

  /// Moves the vertices to start + share · (end − start); serial, cheap. Rebuilds the search grid if some vertex has
  /// moved farther than the skin since the last build. Results never depend on when the grid was built.
  /// @pre set_motion was called; 0 ≤ share ≤ 1
  void move_to(double share);

  /// Triangles wholly outside this box (grown by the reach) may be ignored from the next grid on: pass a box that
  /// contains all grains. Default: no limit.
  void restrict_to(const SurfaceBox& box);

  /// Box of the surface at its present position, and over the whole interval; not grown by any radius.
  SurfaceBox bounds() const;
  SurfaceBox swept_bounds() const;

  /// Finds touched points of the sphere, deepest first; returns their number (0 … min(out.size(), kMaxSurfaceHits)).
  /// Thread-safe, no allocation. Deterministic: depends on centre, radius and vertices only.
  /// @pre 0 < radius ≤ reach
  int hits(const Vec3& centre, double radius, std::span<SurfaceHit> out) const;

  /// Appends the triangles that the sphere may touch, in their order, to `triangles`. @pre 0 < radius ≤ reach
  void near(const Vec3& centre, double radius, std::vector<int>& triangles) const;
  /// The same result as hits(centre, radius, out) if `among` contains all triangles that the sphere may touch.
  /// @pre grid_rebuilds() has not changed since near() found them
  int hits(const Vec3& centre, double radius, std::span<const int> among, std::span<SurfaceHit> out) const;

  /// Velocity of the surface at a hit's point: Σ weight · vertex velocity, m/s.
  Vec3 velocity_at(const SurfaceHit& hit) const;

  const SurfaceMesh& mesh() const;
  std::span<const Vec3> positions() const;   // now, m
  std::span<const Vec3> velocities() const;  // (end − start)/duration, m/s
  std::int64_t grid_rebuilds() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace furrow::terrain
