#include "terrain/surface/surface_collider.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/surface/surface_grid.hpp"
#include "terrain/surface/surface_topology.hpp"
#include "terrain/surface/surface_vectors.hpp"

namespace furrow::terrain {
namespace {

constexpr double kSkinShare = 0.5;  // skin / reach

void take(SurfaceHit& to, const FacetHit& from) {
  FURROW_ASSERT(from.share > 0.0 && from.overlap > 0.0, from.share, from.overlap);
  to.point = vec(from.point);
  to.normal = vec(from.normal);
  to.overlap = from.overlap;
  to.share = from.share;
  to.triangle = from.triangle;
  std::copy_n(from.weight, 3, to.weight.begin());
}

}  // namespace

struct SurfaceCollider::Data {
  SurfaceMesh mesh;
  double reach = 0.0;     // m
  double skin = 0.0;      // m
  double duration = 1.0;  // s
  std::vector<Vec3> start, end, position, velocity;
  std::vector<Vec3> built_at;  // positions with which the grid was built
  std::vector<FacetPlane> plane;
  SurfaceTopology topology;
  std::vector<int> listed;  // triangles in the grid
  SurfaceBox limit{Vec3::Constant(-std::numeric_limits<double>::infinity()),
                   Vec3::Constant(std::numeric_limits<double>::infinity())};
  SurfaceBox built_limit = limit;  // limit with which the grid was built
  bool beyond_built_limit = false;
  SurfaceGrid grid;
  std::int64_t rebuilds = 0;

  bool grid_is_stale() const;
  void rebuild();
  Facets facets() const {
    return {reinterpret_cast<const int*>(mesh.triangles.data()),
            reinterpret_cast<const int*>(topology.neighbour.data()),
            topology.boundary_vertex.data(),
            topology.first.data(),
            topology.incident.data(),
            flat(position),
            plane.data()};
  }
};

bool SurfaceCollider::Data::grid_is_stale() const {
  if (built_at.empty() || beyond_built_limit) return true;
  double farthest = 0.0;
  for (std::size_t v = 0; v < position.size(); ++v)
    farthest = std::max(farthest, (position[v] - built_at[v]).squaredNorm());
  return !(farthest <= skin * skin);
}

void SurfaceCollider::Data::rebuild() {
  listed.clear();
  const double margin = reach + skin;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& v = mesh.triangles[t];
    const Vec3 lo = position[v[0]].cwiseMin(position[v[1]]).cwiseMin(position[v[2]]).array() - margin;
    const Vec3 hi = position[v[0]].cwiseMax(position[v[1]]).cwiseMax(position[v[2]]).array() + margin;
    if ((lo.array() <= limit.hi.array()).all() && (hi.array() >= limit.lo.array()).all()) listed.push_back(t);
  }
  grid.build(position, mesh.triangles, listed, margin);
  built_at = position;
  built_limit = limit;
  beyond_built_limit = false;
  ++rebuilds;
}

SurfaceCollider::SurfaceCollider(const SurfaceMesh& mesh, double reach) : data_(std::make_unique<Data>()) {
  if (!(reach > 0.0) || !std::isfinite(reach))
    throw input_error("contact surface", "", "reach " + std::to_string(reach) + " m, expected a positive length");
  for (const auto& triangle : mesh.triangles)
    for (int v : triangle)
      if (v < 0 || v >= mesh.vertex_count)
        throw input_error("contact surface", "",
                          "a triangle names vertex " + std::to_string(v) + ", expected 0 to " +
                              std::to_string(mesh.vertex_count - 1));
  data_->mesh = mesh;
  data_->reach = reach;
  data_->skin = kSkinShare * reach;
  data_->plane.resize(mesh.triangles.size());
  data_->topology = SurfaceTopology(mesh);
}

SurfaceCollider::~SurfaceCollider() = default;
SurfaceCollider::SurfaceCollider(SurfaceCollider&&) noexcept = default;
SurfaceCollider& SurfaceCollider::operator=(SurfaceCollider&&) noexcept = default;

void SurfaceCollider::set_motion(std::span<const Vec3> start, std::span<const Vec3> end, double duration) {
  const std::size_t count = static_cast<std::size_t>(data_->mesh.vertex_count);
  if (start.size() != count || end.size() != count || !(duration > 0.0))
    throw input_error("contact surface", "",
                      "a motion of " + std::to_string(start.size()) + " to " + std::to_string(end.size()) +
                          " vertices, expected " + std::to_string(count) + " and a positive duration");
  Data& d = *data_;
  d.duration = duration;
  d.start.assign(start.begin(), start.end());
  d.end.assign(end.begin(), end.end());
  d.velocity.resize(count);
  for (std::size_t v = 0; v < count; ++v) d.velocity[v] = (end[v] - start[v]) / duration;
  // If the interval begins where the last one ended, everything is up to date.
  if (d.position != d.start || d.beyond_built_limit) move_to(0.0);
}

void SurfaceCollider::move_to(double share) {
  FURROW_ASSERT(share >= 0.0 && share <= 1.0, share);
  FURROW_ASSERT(data_->start.size() == data_->end.size(), data_->start.size(), data_->end.size());
  Data& d = *data_;
  d.position.resize(d.start.size());
  if (share == 1.0)
    d.position = d.end;  // exactly, as the next interval begins there
  else
    for (std::size_t v = 0; v < d.start.size(); ++v) d.position[v] = d.start[v] + share * (d.end[v] - d.start[v]);
  if (d.grid_is_stale()) d.rebuild();
  const Facets facets = d.facets();
  for (int t : d.listed) d.plane[t] = facets.plane_of(t);
}

void SurfaceCollider::restrict_to(const SurfaceBox& box) {
  Data& d = *data_;
  const SurfaceBox& built = d.built_limit;
  d.beyond_built_limit = (box.lo.array() < built.lo.array()).any() || (box.hi.array() > built.hi.array()).any();
  // The margin allows small changes without a new grid for each.
  d.limit.lo = box.lo.array() - 2.0 * d.reach;
  d.limit.hi = box.hi.array() + 2.0 * d.reach;
}

SurfaceBox SurfaceCollider::bounds() const {
  SurfaceBox box{Vec3::Constant(std::numeric_limits<double>::infinity()),
                 Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (const Vec3& x : data_->position) {
    box.lo = box.lo.cwiseMin(x);
    box.hi = box.hi.cwiseMax(x);
  }
  return box;
}

SurfaceBox SurfaceCollider::swept_bounds() const {
  SurfaceBox box{Vec3::Constant(std::numeric_limits<double>::infinity()),
                 Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (std::size_t v = 0; v < data_->start.size(); ++v) {
    box.lo = box.lo.cwiseMin(data_->start[v]).cwiseMin(data_->end[v]);
    box.hi = box.hi.cwiseMax(data_->start[v]).cwiseMax(data_->end[v]);
  }
  return box;
}

int SurfaceCollider::hits(const Vec3& centre, double radius, std::span<SurfaceHit> out) const {
  return hits(centre, radius, data_->grid.candidates(centre), out);
}

int SurfaceCollider::hits(const Vec3& centre, double radius, std::span<const int> listed,
                          std::span<SurfaceHit> out) const {
  FURROW_ASSERT(radius > 0.0 && radius <= data_->reach, radius, data_->reach);
  const int room = static_cast<int>(std::min<std::size_t>(out.size(), kMaxSurfaceHits));
  if (room == 0) return 0;
  FacetHit found[kMaxSurfaceHits];
  const int count =
      data_->facets().hits(triple(centre), radius, listed.data(), static_cast<int>(listed.size()), found, room);
  for (int k = 0; k < count; ++k) take(out[k], found[k]);
  return count;
}

void SurfaceCollider::near(const Vec3& centre, double radius, std::vector<int>& triangles) const {
  FURROW_ASSERT(radius > 0.0 && radius <= data_->reach, radius, data_->reach);
  const Facets facets = data_->facets();
  for (const int t : data_->grid.candidates(centre))
    if (!facets.off_plane(t, triple(centre), radius)) triangles.push_back(t);
}

Vec3 SurfaceCollider::velocity_at(const SurfaceHit& hit) const {
  FURROW_ASSERT(in_range(hit.triangle, data_->mesh.triangles.size()), hit.triangle, data_->mesh.triangles.size());
  const auto& v = data_->mesh.triangles[hit.triangle];
  return hit.weight[0] * data_->velocity[v[0]] + hit.weight[1] * data_->velocity[v[1]] +
         hit.weight[2] * data_->velocity[v[2]];
}

const SurfaceMesh& SurfaceCollider::mesh() const { return data_->mesh; }
std::span<const Vec3> SurfaceCollider::positions() const { return data_->position; }
std::span<const Vec3> SurfaceCollider::velocities() const { return data_->velocity; }
std::int64_t SurfaceCollider::grid_rebuilds() const { return data_->rebuilds; }

}  // namespace furrow::terrain
