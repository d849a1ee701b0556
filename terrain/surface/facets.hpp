// The points of a triangulated surface (a tire) that a sphere touches, how deep, and the share of the contact law that
// each of them carries. One source for the processor (surface_collider.hpp) and for a GPU (gpu/plugin/): plain numbers,
// no allocation, no function of a library whose bits differ between machines.
//
// A triangle i that the sphere (c, r) intersects gives one candidate: its point p_i closest to c (face, edge or
// vertex region), overlap δ_i = r − |c − p_i| and direction n_i = (c − p_i)/|c − p_i|. On one flat face cut into
// triangles, and on every convex crease, only the deepest candidate may count; in a sharp corner both walls must.
// Both follow from one rule: the push-out D is the shortest vector that clears all candidates (push_out.hpp),
//
//   D = argmin |D|²  with  D·n_i ≥ δ_i  for all i,      D = Σ λ_i n_i,  λ_i ≥ 0,                              (1)
//
// and candidate i carries the share s_i = λ_i/δ̂_i of the contact law:  F = Σ s_i f(δ̂_i) n_i.                   (2)
//
// δ̂_i is δ_i, except that walls of nearly one direction share the depth of the deepest (push_out.hpp). On flat or
// convex surfaces s = 1 for the deepest candidate and 0 for all others. In the middle of a valley whose face normals
// differ by θ, each has s = 1/(1 + cos θ), and |F| = f(δ)/cos(θ/2): the plane's force as θ → 0, and f(δ) on each wall
// at θ = 90°. D, hence F, is continuous in c and in the vertices because p_i is.
//
// The rule needs δ < r/2. If contact is deeper (an emergency), the other candidates fade out from δ = 0.4 r to 0.5 r,
// and the nearest point alone counts. A grain whose centre is behind the surface, by the pseudo-normal of the
// nearest feature [Bærentzen & Aanæs 2005, doi:10.1109/TVCG.2005.49], has δ = r + depth, down to a depth of r.
#pragma once

#include <cstdint>

#include "protocol/core/triple.hpp"
#include "terrain/surface/push_out.hpp"
#include "terrain/surface/triangle_point.hpp"

namespace furrow::terrain {

inline constexpr int kMaxSurfaceHits = 6;

FURROW_HD inline double length(const Vector& v) { return simd::root(dot(v, v)); }

/// Angle between two vectors from the length of their cross product and their dot product, to 1e-11 rad. Without atan2,
/// whose bits differ between libraries: tan of an eighth by three halvings of tan(φ/2) = y/(√(x² + y²) + x), then the
/// series of atan.
FURROW_HD inline double angle_of(double y, double x) {
  const double r = simd::root(x * x + y * y);
  if (!(r > 0.0)) return 0.0;
  double t = x > 0.0 ? y / (r + x) : (r - x) / simd::larger(y, 1e-300);
  t = simd::smaller(t, 1e150);
  for (int k = 0; k < 3; ++k) t = t / (1.0 + simd::root(1.0 + t * t));
  const double s = t * t;
  double sum = 0.0;
  for (int k = 7; k >= 0; --k) sum = 1.0 / (2.0 * k + 1.0) - s * sum;
  return 16.0 * t * sum;
}

/// One touched point, as SurfaceHit.
struct FacetHit {
  Vector point, normal;  // m; unit, towards the grain
  double overlap, share;
  double weight[3];
  std::int32_t triangle;
};

/// Plane n·x = offset of a triangle; n = 0 if it has no area, as its neighbours' edges replace it.
struct FacetPlane {
  Vector normal;
  double offset;  // m

  FURROW_HD bool is_nothing() const { return normal.x == 0.0 && normal.y == 0.0 && normal.z == 0.0; }
  FURROW_HD double height(const Vector& x) const { return dot(normal, x) - offset; }
  FURROW_HD double distance(const Vector& x) const {
    const double h = height(x);
    return h < 0.0 ? -h : h;
  }
};

/// A surface at its present position. Entries of three numbers follow each other.
class Facets {
 public:
  const std::int32_t* triangle;               // its vertices
  const std::int32_t* neighbour;              // triangle across edge k (vertex k to k+1); −1 if there is none
  const std::uint8_t* boundary;               // of a vertex: 1 on an edge that does not border exactly two triangles
  const std::int32_t *around_first, *around;  // vertex → its triangles, as slices of `around`
  const double* position;                     // of the vertices, m
  const FacetPlane* plane;

  FURROW_HD const std::int32_t* corners(std::int32_t t) const { return triangle + 3 * t; }
  FURROW_HD Vector at(std::int32_t vertex) const {
    const double* const x = position + 3 * vertex;
    return {x[0], x[1], x[2]};
  }
  FURROW_HD Vector twice_area(std::int32_t t) const {
    const std::int32_t* const v = corners(t);
    return cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0]));
  }
  FURROW_HD FacetPlane plane_of(std::int32_t t) const {
    const Vector area = twice_area(t);
    const double size = length(area);
    const Vector normal = size > 1e-30 ? (1.0 / size) * area : Vector{0, 0, 0};
    return {normal, dot(normal, at(corners(t)[0]))};
  }
  FURROW_HD bool off_plane(std::int32_t t, const Vector& centre, double radius) const {
    return plane[t].distance(centre) >= radius;
  }

  /// Touched points of a sphere, the deepest first; returns their number, at most `room`.
  /// @param listed triangles that it may touch, in ascending order @pre 0 < room ≤ kMaxSurfaceHits
  FURROW_HD int hits(const Vector& centre, double radius, const std::int32_t* listed, int count, FacetHit* out,
                     int room = kMaxSurfaceHits) const {
    // Most grains near a tire do not touch it: for them the function returns before a candidate list exists.
    int first = 0;
    while (first < count && off_plane(listed[first], centre, radius)) ++first;
    if (first == count) return 0;
    Candidates found;
    found.size = 0;
    for (int k = first; k < count; ++k)
      if (!off_plane(listed[k], centre, radius)) consider(listed[k], centre, radius, found);
    if (found.size == 0) return 0;

    const Candidate& nearest = found.item[0];
    if (behind(nearest, centre)) {
      write(out[0], nearest, radius + nearest.distance, 1.0);
      if (nearest.at.region != TriangleRegion::face && nearest.distance > kSamePoint * radius)
        out[0].normal = -1.0 * nearest.normal;
      return 1;
    }
    if (found.size == 1) {
      write(out[0], nearest, radius - nearest.distance, 1.0);
      return 1;
    }
    return share_out(found, centre, radius, out, room);
  }

 private:
  static constexpr double kSamePoint = 1e-9;  // of the radius: candidates nearer to each other than this are one

  struct Candidate {
    TrianglePoint at;
    Vector normal;
    double distance;  // |c − p|, m
    std::int32_t triangle;
  };
  /// The deepest candidates, ordered by distance and then by triangle.
  struct Candidates {
    Candidate item[kMaxWalls];
    int size;
  };

  FURROW_HD static void insert(Candidates& found, const Candidate& one, double same_point) {
    for (int i = 0; i < found.size; ++i) {
      const Vector d = found.item[i].at.point - one.at.point;
      if (dot(d, d) < same_point * same_point) return;
    }
    if (found.size == kMaxWalls) {
      if (one.distance >= found.item[found.size - 1].distance) return;
      --found.size;
    }
    int place = found.size++;
    for (; place > 0 && found.item[place - 1].distance > one.distance; --place)
      found.item[place] = found.item[place - 1];
    found.item[place] = one;
  }

  FURROW_HD void consider(std::int32_t t, const Vector& centre, double radius, Candidates& found) const {
    if (plane[t].is_nothing()) return;
    const std::int32_t* const v = corners(t);
    Candidate one{closest_point(centre, at(v[0]), at(v[1]), at(v[2])), plane[t].normal, 0.0, t};
    if (one.at.region == TriangleRegion::face) {
      one.distance = plane[t].distance(centre);
    } else {
      const Vector offset = centre - one.at.point;
      const double squared = dot(offset, offset);
      if (squared >= radius * radius) return;
      one.distance = simd::root(squared);
      // If the centre is on the feature itself, the offset has no direction.
      if (one.distance > kSamePoint * radius) one.normal = (1.0 / one.distance) * offset;
    }
    insert(found, one, kSamePoint * radius);
  }

  /// Whether the centre is behind the nearest point, by its feature's pseudo-normal. Boundary edges have no back side.
  FURROW_HD bool behind(const Candidate& nearest, const Vector& centre) const {
    const Vector offset = centre - nearest.at.point;
    const std::int32_t t = nearest.triangle;
    if (nearest.at.region == TriangleRegion::face) return plane[t].height(centre) < 0.0;
    if (nearest.at.region > TriangleRegion::edge_2) return behind_vertex(corners(t)[nearest.at.vertex()], offset);
    const std::int32_t other = neighbour[3 * t + nearest.at.edge()];
    if (other < 0) return false;
    const Vector area = twice_area(other);
    return dot(plane[t].normal + (1.0 / simd::larger(length(area), 1e-300)) * area, offset) < 0.0;
  }
  /// By the angle-weighted pseudo-normal of a vertex; angles are only computed if its triangles disagree.
  FURROW_HD bool behind_vertex(std::int32_t vertex, const Vector& offset) const {
    if (boundary[vertex]) return false;
    const std::int32_t first = around_first[vertex], last = around_first[vertex + 1];
    int back = 0;
    for (std::int32_t k = first; k < last; ++k)
      if (dot(twice_area(around[k]), offset) < 0.0) ++back;
    if (back == 0 || back == last - first) return back > 0;
    double sum = 0.0;
    for (std::int32_t k = first; k < last; ++k) {
      const std::int32_t* const v = corners(around[k]);
      const int own = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
      const Vector a = at(v[(own + 1) % 3]) - at(vertex), b = at(v[(own + 2) % 3]) - at(vertex);
      const Vector area = cross(a, b);
      const double size = length(area);
      if (size > 1e-30) sum += angle_of(size, dot(a, b)) * dot(area, offset) / size;
    }
    return sum < 0.0;
  }

  FURROW_HD static void write(FacetHit& hit, const Candidate& from, double overlap, double share) {
    const double* const w = from.at.weight;
    hit = {from.at.point, from.normal, overlap, share, {w[0], w[1], w[2]}, from.triangle};
  }

  /// Eqs. (1) and (2) for a sphere whose centre is in front of the surface.
  FURROW_HD int share_out(const Candidates& found, const Vector& centre, double radius, FacetHit* out, int room) const {
    constexpr double kFadeFrom = 0.4, kFadeTo = 0.5;  // of the radius: overlaps where others fade
    const double deepest = radius - found.item[0].distance;
    const double fade = simd::smaller(simd::larger((kFadeTo - deepest / radius) / (kFadeTo - kFadeFrom), 0.0), 1.0);
    Vector normal[kMaxWalls];
    double depth[kMaxWalls], faded[kMaxWalls], shared[kMaxWalls], lambda[kMaxWalls];
    int source[kMaxWalls], count = 0;
    for (int i = 0; i < found.size; ++i) {
      const Candidate& one = found.item[i];
      const double own_fade = i == 0 ? 1.0 : fade;
      // A face seen from behind, while a nearer one is seen from the front, belongs to the far side of a wedge.
      const bool far_side = i > 0 && one.at.region == TriangleRegion::face && plane[one.triangle].height(centre) < 0.0;
      if (far_side || !(own_fade > 0.0)) continue;
      normal[count] = one.normal;
      depth[count] = radius - one.distance;
      faded[count] = own_fade * depth[count];
      source[count] = i;
      ++count;
    }
    const bool several = push_out(normal, faded, count, lambda) > 1;
    if (several) share_depth(normal, depth, count, shared);
    int written = 0;
    for (int i = 0; i < count && written < room; ++i) {
      if (!(lambda[i] > 0.0)) continue;
      const double overlap = several ? shared[i] : depth[i];
      write(out[written++], found.item[source[i]], overlap, lambda[i] / overlap);
    }
    return written;
  }
};

}  // namespace furrow::terrain
