#include "terrain/surface/surface_collider.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/surface/surface_geometry.hpp"
#include "terrain/surface/surface_grid.hpp"
#include "terrain/surface/surface_topology.hpp"

namespace furrow::terrain {
namespace {

// Shares of the sphere's radius, except kSkinShare.
constexpr double kFadeFrom = 0.4;    // overlap where other candidates begin to fade
constexpr double kFadeTo = 0.5;      // overlap from which only the nearest point counts
constexpr double kSamePoint = 1e-9;  // candidates nearer to each other than this count as one
constexpr double kSkinShare = 0.5;   // skin / reach

/// Plane n·x = offset of a triangle; n = 0 if it has no area, as its neighbours' edges replace it.
struct TrianglePlane {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;  // m
};

struct Candidate {
  TrianglePoint at;
  Vec3 normal = Vec3::Zero();
  double distance = 0.0;  // |c − p|, m
  int triangle = -1;
};

/// The deepest candidates, ordered by distance and then by triangle.
struct CandidateList {
  std::array<Candidate, kMaxCandidates> item;
  int size = 0;

  void insert(const Candidate& candidate, double same_point) {
    FURROW_ASSERT(candidate.triangle >= 0 && same_point >= 0.0, candidate.triangle, same_point);
    for (int i = 0; i < size; ++i)
      if ((item[i].at.point - candidate.at.point).squaredNorm() < same_point * same_point) return;
    if (size == kMaxCandidates) {
      if (candidate.distance >= item[size - 1].distance) return;
      --size;
    }
    int place = size++;
    for (; place > 0 && item[place - 1].distance > candidate.distance; --place) item[place] = item[place - 1];
    item[place] = candidate;
  }
};

void write_hit(SurfaceHit& hit, const Candidate& from, double overlap, double share) {
  FURROW_ASSERT(share > 0.0 && overlap > 0.0, share, overlap);
  hit.point = from.at.point;
  hit.normal = from.normal;
  hit.overlap = overlap;
  hit.share = share;
  hit.triangle = from.triangle;
  hit.weight = from.at.weight;
}

}  // namespace

struct SurfaceCollider::Data {
  SurfaceMesh mesh;
  double reach = 0.0;     // m
  double skin = 0.0;      // m
  double duration = 1.0;  // s
  std::vector<Vec3> start, end, position, velocity;
  std::vector<Vec3> built_at;  // positions with which the grid was built
  std::vector<TrianglePlane> plane;
  SurfaceTopology topology;
  std::vector<int> listed;  // triangles in the grid
  SurfaceBox limit{Vec3::Constant(-std::numeric_limits<double>::infinity()),
                   Vec3::Constant(std::numeric_limits<double>::infinity())};
  SurfaceBox built_limit = limit;  // limit with which the grid was built
  bool beyond_built_limit = false;
  SurfaceGrid grid;
  std::int64_t rebuilds = 0;

  void update_planes();
  bool grid_is_stale() const;
  void rebuild();
  Vec3 cross(int t) const {
    const auto& v = mesh.triangles[t];
    return (position[v[1]] - position[v[0]]).cross(position[v[2]] - position[v[0]]);
  }
  bool off_plane(int t, const Vec3& centre, double radius) const {
    return std::abs(plane[t].normal.dot(centre) - plane[t].offset) >= radius;
  }
  bool behind(const Candidate& nearest, const Vec3& centre) const;
  bool behind_vertex(int vertex, const Vec3& offset) const;
  void consider(int t, const Vec3& centre, double radius, CandidateList& found) const;
  int share_out(const CandidateList& found, const Vec3& centre, double radius, std::span<SurfaceHit> out) const;
};

void SurfaceCollider::Data::update_planes() {
  for (int t : listed) {
    const Vec3 area = cross(t);
    const double length = area.norm();
    plane[t].normal = length > 1e-30 ? Vec3(area / length) : Vec3::Zero();
    plane[t].offset = plane[t].normal.dot(position[mesh.triangles[t][0]]);
  }
}

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

/// Whether the centre is behind the nearest point, by its feature's pseudo-normal. Boundary edges have no back side.
bool SurfaceCollider::Data::behind(const Candidate& nearest, const Vec3& centre) const {
  const Vec3 offset = centre - nearest.at.point;
  const int t = nearest.triangle;
  if (nearest.at.region == TriangleRegion::face) return plane[t].normal.dot(centre) < plane[t].offset;
  if (nearest.at.region <= TriangleRegion::edge_2) {
    const int other =
        topology.neighbour[t][static_cast<int>(nearest.at.region) - static_cast<int>(TriangleRegion::edge_0)];
    if (other < 0) return false;
    const Vec3 area = cross(other);
    return (plane[t].normal + area / std::max(area.norm(), 1e-300)).dot(offset) < 0.0;
  }
  const int corner = static_cast<int>(nearest.at.region) - static_cast<int>(TriangleRegion::vertex_0);
  return behind_vertex(mesh.triangles[t][corner], offset);
}

/// By the angle-weighted pseudo-normal of a vertex; angles are only computed if its triangles disagree.
bool SurfaceCollider::Data::behind_vertex(int vertex, const Vec3& offset) const {
  FURROW_ASSERT(in_range(vertex, mesh.vertex_count), vertex, mesh.vertex_count);
  if (topology.boundary_vertex[vertex]) return false;
  int front = 0, back = 0;
  double sum = 0.0;
  for (int t : topology.around(vertex)) (cross(t).dot(offset) < 0.0 ? back : front) += 1;
  if (front == 0 || back == 0) return front == 0;
  for (int t : topology.around(vertex)) {
    const auto& v = mesh.triangles[t];
    const int k = static_cast<int>(std::find(v.begin(), v.end(), vertex) - v.begin());
    const Vec3 a = position[v[(k + 1) % 3]] - position[vertex], b = position[v[(k + 2) % 3]] - position[vertex];
    const Vec3 area = a.cross(b);
    const double length = area.norm();
    if (length > 1e-30) sum += std::atan2(length, a.dot(b)) * area.dot(offset) / length;
  }
  return sum < 0.0;
}

void SurfaceCollider::Data::consider(int t, const Vec3& centre, double radius, CandidateList& found) const {
  if (plane[t].normal.isZero(0.0)) return;
  const auto& v = mesh.triangles[t];
  Candidate candidate;
  candidate.triangle = t;
  candidate.at = closest_point(centre, position[v[0]], position[v[1]], position[v[2]]);
  const Vec3 offset = centre - candidate.at.point;
  if (candidate.at.region == TriangleRegion::face) {
    candidate.distance = std::abs(plane[t].normal.dot(centre) - plane[t].offset);
    candidate.normal = plane[t].normal;
  } else {
    const double squared = offset.squaredNorm();
    if (squared >= radius * radius) return;
    candidate.distance = std::sqrt(squared);
    // If the centre is on the feature itself, the offset has no direction.
    candidate.normal = candidate.distance > kSamePoint * radius ? Vec3(offset / candidate.distance) : plane[t].normal;
  }
  found.insert(candidate, kSamePoint * radius);
}

/// Eqs. (1) and (2) for a sphere whose centre is in front of the surface.
int SurfaceCollider::Data::share_out(const CandidateList& found, const Vec3& centre, double radius,
                                     std::span<SurfaceHit> out) const {
  FURROW_ASSERT(found.size > 0 && !out.empty(), found.size, out.size());
  const double deepest = radius - found.item[0].distance;
  const double fade = std::clamp((kFadeTo - deepest / radius) / (kFadeTo - kFadeFrom), 0.0, 1.0);
  std::array<Vec3, kMaxCandidates> normal;
  std::array<double, kMaxCandidates> depth, faded, shared, lambda;
  std::array<int, kMaxCandidates> source;
  std::size_t count = 0;
  for (int i = 0; i < found.size; ++i) {
    const Candidate& one = found.item[i];
    const double own_fade = i == 0 ? 1.0 : fade;
    // A face seen from behind, while a nearer one is seen from the front, belongs to the far side of a wedge.
    const bool far_side =
        i > 0 && one.at.region == TriangleRegion::face && one.normal.dot(centre) < plane[one.triangle].offset;
    if (far_side || !(own_fade > 0.0)) continue;
    normal[count] = one.normal;
    depth[count] = radius - one.distance;
    faded[count] = own_fade * depth[count];
    source[count] = i;
    ++count;
  }
  auto first = [count](auto& values) { return std::span(values.data(), count); };
  if (solve_push_out(first(normal), first(faded), first(lambda)) > 1)
    share_depth(first(normal), first(depth), first(shared));
  else
    shared = depth;
  std::size_t written = 0;
  for (std::size_t i = 0; i < count && written < out.size(); ++i)
    if (lambda[i] > 0.0) write_hit(out[written++], found.item[source[i]], shared[i], lambda[i] / shared[i]);
  return static_cast<int>(written);
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
  d.update_planes();
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
  const Data& d = *data_;
  // Most grains near a tire do not touch it: for them the function returns before a candidate list exists.
  std::size_t first = 0;
  while (first < listed.size() && d.off_plane(listed[first], centre, radius)) ++first;
  if (first == listed.size() || out.empty()) return 0;

  CandidateList found;
  for (std::size_t i = first; i < listed.size(); ++i)
    if (!d.off_plane(listed[i], centre, radius)) d.consider(listed[i], centre, radius, found);
  if (found.size == 0) return 0;

  const Candidate& nearest = found.item[0];
  if (d.behind(nearest, centre)) {
    write_hit(out[0], nearest, radius + nearest.distance, 1.0);
    if (nearest.at.region != TriangleRegion::face && nearest.distance > kSamePoint * radius)
      out[0].normal = -nearest.normal;
    return 1;
  }
  if (found.size == 1) {
    write_hit(out[0], nearest, radius - nearest.distance, 1.0);
    return 1;
  }
  return d.share_out(found, centre, radius, out);
}

void SurfaceCollider::near(const Vec3& centre, double radius, std::vector<int>& triangles) const {
  FURROW_ASSERT(radius > 0.0 && radius <= data_->reach, radius, data_->reach);
  for (const int t : data_->grid.candidates(centre))
    if (!data_->off_plane(t, centre, radius)) triangles.push_back(t);
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
