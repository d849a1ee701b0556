// Small surfaces that the contact tests share.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "protocol/core/surface.hpp"
#include "terrain/surface/surface_collider.hpp"

namespace furrow::testing {

struct Surface {
  SurfaceMesh mesh;
  std::vector<Vec3> vertex;

  void add(int a, int b, int c) { mesh.triangles.push_back({a, b, c}); }
  terrain::SurfaceCollider collider(double reach) const {
    terrain::SurfaceCollider result(mesh, reach);
    result.set_motion(vertex, vertex, 1.0);
    return result;
  }
};

/// State of a rigid surface at a place (m), turned about +y (rad) and turning (rad/s).
inline SurfaceState placed(const Surface& surface, const Vec3& shift, const Vec3& velocity, double turn = 0.0,
                           double spin = 0.0) {
  const Quat orientation(Eigen::AngleAxisd(turn, Vec3::UnitY()));
  SurfaceState state;
  for (const Vec3& x : surface.vertex) {
    const Vec3 arm = orientation * x;
    state.position.push_back(shift + arm);
    state.velocity.push_back(velocity + Vec3(0.0, spin, 0.0).cross(arm));
  }
  return state;
}

inline SurfaceState at_rest(const Surface& surface) {
  return {surface.vertex, std::vector<Vec3>(surface.vertex.size(), Vec3::Zero())};
}

/// nx × ny quads over [x0, x0 + nx h] × [y0, y0 + ny h] lifted to z = height(x, y), outside up, each quad cut along a
/// diagonal that alternates.
inline Surface sheet(double x0, double y0, double h, int nx, int ny,
                     const std::function<double(double, double)>& height) {
  Surface s;
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j) s.vertex.emplace_back(x0 + i * h, y0 + j * h, height(x0 + i * h, y0 + j * h));
  s.mesh.vertex_count = static_cast<int>(s.vertex.size());
  auto id = [&](int i, int j) { return i * (ny + 1) + j; };
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      if ((i + j) % 2 == 0) {
        s.add(id(i, j), id(i + 1, j), id(i + 1, j + 1));
        s.add(id(i, j), id(i + 1, j + 1), id(i, j + 1));
      } else {
        s.add(id(i, j), id(i + 1, j), id(i, j + 1));
        s.add(id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
      }
  return s;
}

/// The surface with its outside down.
inline Surface turned_down(Surface s) {
  for (auto& t : s.mesh.triangles) std::swap(t[1], t[2]);
  return s;
}

/// A rectangle at a height, outside down.
inline Surface under_side(double x0, double x1, double y0, double y1, double z) {
  Surface s;
  s.vertex = {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
  s.mesh.vertex_count = 4;
  s.add(0, 1, 2);
  s.add(0, 2, 3);
  return s;
}

/// Two half planes that meet along the y axis, each rising by `angle` away from it (> 0: a valley, < 0: a ridge).
inline Surface crease(double angle, double size = 0.05) {
  return sheet(-size, -size, size, 2, 2, [=](double x, double) { return std::abs(x) * std::tan(angle); });
}

/// `count` triangles around the origin with rim heights given by height(k).
inline Surface fan(int count, double size, const std::function<double(int)>& height) {
  Surface s;
  s.vertex.push_back(Vec3::Zero());
  for (int k = 0; k < count; ++k) {
    const double phi = 2.0 * M_PI * k / count;
    s.vertex.emplace_back(size * std::cos(phi), size * std::sin(phi), height(k));
  }
  s.mesh.vertex_count = count + 1;
  for (int k = 0; k < count; ++k) s.add(0, 1 + k, 1 + (k + 1) % count);
  return s;
}

/// Closed box [lo, hi], twelve triangles, outside out.
inline Surface box(const Vec3& lo, const Vec3& hi) {
  Surface s;
  for (int i = 0; i < 8; ++i)
    s.vertex.emplace_back(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
  s.mesh.vertex_count = 8;
  const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quad) {
    s.add(q[0], q[1], q[2]);
    s.add(q[0], q[2], q[3]);
  }
  return s;
}

/// Closed wheel: `facets` around the y axis, `across` strips, side discs as fans.
inline Surface wheel(double radius, double width, int facets, int across) {
  Surface s;
  for (int k = 0; k < facets; ++k)
    for (int j = 0; j <= across; ++j) {
      const double phi = 2.0 * M_PI * k / facets;
      s.vertex.emplace_back(radius * std::sin(phi), -0.5 * width + width * j / across, -radius * std::cos(phi));
    }
  const int left = static_cast<int>(s.vertex.size()), right = left + 1;
  s.vertex.emplace_back(0.0, -0.5 * width, 0.0);
  s.vertex.emplace_back(0.0, 0.5 * width, 0.0);
  s.mesh.vertex_count = right + 1;
  auto id = [&](int k, int j) { return (k % facets) * (across + 1) + j; };
  for (int k = 0; k < facets; ++k) {
    for (int j = 0; j < across; ++j) {
      s.add(id(k, j), id(k, j + 1), id(k + 1, j + 1));
      s.add(id(k, j), id(k + 1, j + 1), id(k + 1, j));
    }
    s.add(left, id(k, 0), id(k + 1, 0));
    s.add(right, id(k + 1, across), id(k, across));
  }
  return s;
}

/// Σ share · overlap^1.5 · normal: force of a Hertz law of unit stiffness from the hits.
inline Vec3 hertz_force(const terrain::SurfaceCollider& surface, const Vec3& centre, double radius) {
  std::array<terrain::SurfaceHit, terrain::kMaxSurfaceHits> hit;
  const int count = surface.hits(centre, radius, hit);
  Vec3 force = Vec3::Zero();
  for (int i = 0; i < count; ++i) force += hit[i].share * std::pow(hit[i].overlap, 1.5) * hit[i].normal;
  return force;
}

}  // namespace furrow::testing
