// A sphere and a triangulated surface: terrain/surface/surface_geometry.hpp and surface_collider.hpp as device code, on
// plain triples. Laws, constants and order of operations are those of these files.
#pragma once

#include "protocol/core/triple.hpp"
#include "terrain/gpu/plugin/device.hpp"

namespace furrow::terrain::gpu {

using simd::Triple;
using Vector = Triple<double>;

FURROW_HD inline double least(double a, double b) { return a < b ? a : b; }
FURROW_HD inline double most(double a, double b) { return a > b ? a : b; }
FURROW_HD inline double within(double v, double low, double high) { return least(most(v, low), high); }
FURROW_HD inline double size_of(double v) { return v < 0.0 ? -v : v; }
FURROW_HD inline double length(const Vector& v) { return simd::root(dot(v, v)); }
FURROW_HD inline Vector opposite(const Vector& v) { return {-v.x, -v.y, -v.z}; }
FURROW_HD inline bool is_zero(const Vector& v) { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; }

enum class Region : i32 { face, edge_0, edge_1, edge_2, vertex_0, vertex_1, vertex_2 };

struct PointOfTriangle {
  Vector point;
  double weight[3];  // barycentric
  Region region;
};

FURROW_HD inline PointOfTriangle on_edge(const Vector& from, const Vector& to, double share, int edge) {
  PointOfTriangle at;
  at.point = from + share * (to - from);
  at.weight[0] = at.weight[1] = at.weight[2] = 0.0;
  at.weight[edge] = 1.0 - share;
  at.weight[(edge + 1) % 3] = share;
  at.region = static_cast<Region>(static_cast<i32>(Region::edge_0) + edge);
  return at;
}
FURROW_HD inline PointOfTriangle on_vertex(const Vector& vertex, int index) {
  PointOfTriangle at;
  at.point = vertex;
  at.weight[0] = at.weight[1] = at.weight[2] = 0.0;
  at.weight[index] = 1.0;
  at.region = static_cast<Region>(static_cast<i32>(Region::vertex_0) + index);
  return at;
}

/// Point of triangle (a, b, c) closest to p [Ericson 2005, §5.1.5]. @pre the triangle has an area
FURROW_HD inline PointOfTriangle closest_point(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return on_vertex(a, 0);
  const Vector bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return on_vertex(b, 1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return on_edge(a, b, d1 / (d1 - d3), 0);
  const Vector cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return on_vertex(c, 2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return on_edge(c, a, 1.0 - d2 / (d2 - d6), 2);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return on_edge(b, c, (d4 - d3) / (d4 - d3 + d5 - d6), 1);
  const double sum = va + vb + vc;
  PointOfTriangle at;
  at.weight[1] = vb / sum;
  at.weight[2] = vc / sum;
  at.weight[0] = 1.0 - at.weight[1] - at.weight[2];
  at.point = a + at.weight[1] * ab + at.weight[2] * ac;
  at.region = Region::face;
  return at;
}

/// Angle between two vectors from the length of their cross product and their dot product, to 1e-11 rad. Without atan2,
/// whose bits differ between libraries: tan of an eighth by three halvings of tan(φ/2) = y/(√(x² + y²) + x), then the
/// series of atan.
FURROW_HD inline double angle_of(double y, double x) {
  const double r = simd::root(x * x + y * y);
  if (!(r > 0.0)) return 0.0;
  double t = x > 0.0 ? y / (r + x) : (r - x) / most(y, 1e-300);
  t = least(t, 1e150);
  for (int k = 0; k < 3; ++k) t = t / (1.0 + simd::root(1.0 + t * t));
  const double s = t * t;
  double sum = 0.0;
  for (int k = 7; k >= 0; --k) sum = 1.0 / (2.0 * k + 1.0) - s * sum;
  return 16.0 * t * sum;
}

inline constexpr int kCandidates = 16, kHits = 6, kActive = 6;
inline constexpr double kRegular = 1e-12, kLack = 1e-11;

FURROW_HD inline double coupling(const Vector* normal, int i, int j) {
  const double c = dot(normal[i], normal[j]);
  return c > 0.0 ? c : 0.0;
}

/// The candidates that carry a share (surface_geometry.hpp, solve_push_out).
struct ActiveWalls {
  int index[kActive];
  double lambda[kActive];
  int size;

  FURROW_HD bool holds(int i) const {
    for (int k = 0; k < size; ++k)
      if (index[k] == i) return true;
    return false;
  }
  FURROW_HD void drop(int k) {
    for (int i = k; i + 1 < size; ++i) index[i] = index[i + 1], lambda[i] = lambda[i + 1];
    --size;
  }
  /// Solves G_AA x = δ_A by elimination.
  FURROW_HD void solve(const Vector* normal, const double* overlap, double* x) const {
    double g[kActive][kActive + 1];
    const int n = size;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) g[i][j] = i == j ? 1.0 + kRegular : coupling(normal, index[i], index[j]);
      g[i][n] = overlap[index[i]];
    }
    for (int k = 0; k < n; ++k) {
      if (size_of(g[k][k]) < kRegular) g[k][k] = kRegular;
      for (int i = k + 1; i < n; ++i) {
        const double factor = g[i][k] / g[k][k];
        for (int j = k; j <= n; ++j) g[i][j] -= factor * g[k][j];
      }
    }
    for (int k = n - 1; k >= 0; --k) {
      double sum = g[k][n];
      for (int j = k + 1; j < n; ++j) sum -= g[k][j] * x[j];
      x[k] = sum / g[k][k];
    }
  }
  FURROW_HD void settle(const Vector* normal, const double* overlap) {
    while (size > 0) {
      double x[kActive];
      solve(normal, overlap, x);
      double way = 1.0;
      int first_out = -1;
      for (int k = 0; k < size; ++k) {
        if (x[k] > 0.0) continue;
        const double share = lambda[k] / (lambda[k] - x[k] + 1e-300);
        if (first_out < 0 || share < way) way = share, first_out = k;
      }
      for (int k = 0; k < size; ++k) lambda[k] = first_out < 0 ? x[k] : lambda[k] + way * (x[k] - lambda[k]);
      if (first_out < 0) return;
      drop(first_out);
    }
  }
};

/// Multipliers λ of the shortest push-out; returns the number of λ > 0. @pre 0 ≤ n ≤ kCandidates
FURROW_HD inline int push_out(const Vector* normal, const double* overlap, int n, double* lambda) {
  for (int i = 0; i < n; ++i) lambda[i] = 0.0;
  if (n == 0) return 0;
  int deepest = 0;
  for (int i = 1; i < n; ++i)
    if (overlap[i] > overlap[deepest]) deepest = i;
  const double tolerance = kLack * overlap[deepest];
  u32 left_out = 0;
  ActiveWalls active;
  active.size = 1;
  active.index[0] = deepest;
  active.lambda[0] = overlap[deepest] / (1.0 + kRegular);
  for (int round = 0; round < 4 * kActive && active.size < kActive; ++round) {
    double worst = tolerance;
    int next = -1;
    for (int i = 0; i < n; ++i) {
      if (active.holds(i) || (left_out >> i & 1U)) continue;
      double lack = overlap[i];
      for (int k = 0; k < active.size; ++k) lack -= active.lambda[k] * coupling(normal, i, active.index[k]);
      if (lack > worst) worst = lack, next = i;
    }
    if (next < 0) break;
    active.index[active.size] = next;
    active.lambda[active.size] = 0.0;
    ++active.size;
    active.settle(normal, overlap);
    if (!active.holds(next)) left_out |= 1U << next;
  }
  int count = 0;
  for (int k = 0; k < active.size; ++k) {
    const int i = active.index[k];
    lambda[i] = least(active.lambda[k] * (1.0 + kRegular), overlap[i]);
    if (lambda[i] > 0.0) ++count;
  }
  return count;
}

/// Walls of nearly one direction share the depth of the deepest of them.
FURROW_HD inline void share_depth(const Vector* normal, const double* overlap, int n, double* shared) {
  constexpr double kFull = 0.7, kNone = 0.3;
  for (int i = 0; i < n; ++i) {
    shared[i] = overlap[i];
    for (int j = 0; j < n; ++j) {
      if (overlap[j] <= overlap[i]) continue;
      const double w = within((dot(normal[i], normal[j]) - kNone) / (kFull - kNone), 0.0, 1.0);
      shared[i] = most(shared[i], overlap[i] + w * (overlap[j] - overlap[i]));
    }
  }
}

struct FacetHit {
  Vector point, normal;  // m; unit, towards the grain
  double overlap, share;
  double weight[3];
  i32 triangle;
};

struct FacetPlane {
  Vector normal;  // 0 if the triangle has no area
  double offset;
};

struct Candidate {
  PointOfTriangle at;
  Vector normal;
  double distance;
  i32 triangle;
};

/// A surface at its present position.
struct Facets {
  const i32 (*triangle)[3];
  const i32 (*neighbour)[3];
  const std::uint8_t* boundary;
  const i32 *around_first, *around;
  const Vector* position;
  const FacetPlane* plane;

  FURROW_HD Vector twice_area(i32 t) const {
    const i32* const v = triangle[t];
    return cross(position[v[1]] - position[v[0]], position[v[2]] - position[v[0]]);
  }
  FURROW_HD bool off_plane(i32 t, const Vector& centre, double radius) const {
    return size_of(dot(plane[t].normal, centre) - plane[t].offset) >= radius;
  }

  FURROW_HD bool behind(const Candidate& nearest, const Vector& centre) const {
    const Vector offset = centre - nearest.at.point;
    const i32 t = nearest.triangle;
    if (nearest.at.region == Region::face) return dot(plane[t].normal, centre) < plane[t].offset;
    if (nearest.at.region <= Region::edge_2) {
      const i32 other = neighbour[t][static_cast<i32>(nearest.at.region) - static_cast<i32>(Region::edge_0)];
      if (other < 0) return false;
      const Vector area = twice_area(other);
      return dot(plane[t].normal + (1.0 / most(length(area), 1e-300)) * area, offset) < 0.0;
    }
    const i32 corner = static_cast<i32>(nearest.at.region) - static_cast<i32>(Region::vertex_0);
    return behind_vertex(triangle[t][corner], offset);
  }
  FURROW_HD bool behind_vertex(i32 vertex, const Vector& offset) const {
    if (boundary[vertex]) return false;
    int front = 0, back = 0;
    for (i32 k = around_first[vertex]; k < around_first[vertex + 1]; ++k)
      (dot(twice_area(around[k]), offset) < 0.0 ? back : front) += 1;
    if (front == 0 || back == 0) return front == 0;
    double sum = 0.0;
    for (i32 k = around_first[vertex]; k < around_first[vertex + 1]; ++k) {
      const i32* const v = triangle[around[k]];
      const int own = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
      const Vector a = position[v[(own + 1) % 3]] - position[vertex], b = position[v[(own + 2) % 3]] - position[vertex];
      const Vector area = cross(a, b);
      const double size = length(area);
      if (size > 1e-30) sum += angle_of(size, dot(a, b)) * dot(area, offset) / size;
    }
    return sum < 0.0;
  }

  static constexpr double kSamePoint = 1e-9;

  FURROW_HD void consider(i32 t, const Vector& centre, double radius, Candidate* found, int& size) const {
    if (is_zero(plane[t].normal)) return;
    const i32* const v = triangle[t];
    Candidate one;
    one.triangle = t;
    one.at = closest_point(centre, position[v[0]], position[v[1]], position[v[2]]);
    const Vector offset = centre - one.at.point;
    if (one.at.region == Region::face) {
      one.distance = size_of(dot(plane[t].normal, centre) - plane[t].offset);
      one.normal = plane[t].normal;
    } else {
      const double squared = dot(offset, offset);
      if (squared >= radius * radius) return;
      one.distance = simd::root(squared);
      one.normal = one.distance > kSamePoint * radius ? (1.0 / one.distance) * offset : plane[t].normal;
    }
    const double same = kSamePoint * radius;
    for (int i = 0; i < size; ++i) {
      const Vector d = found[i].at.point - one.at.point;
      if (dot(d, d) < same * same) return;
    }
    if (size == kCandidates) {
      if (one.distance >= found[size - 1].distance) return;
      --size;
    }
    int place = size++;
    for (; place > 0 && found[place - 1].distance > one.distance; --place) found[place] = found[place - 1];
    found[place] = one;
  }

  FURROW_HD static void write(FacetHit& hit, const Candidate& from, double overlap, double share) {
    hit.point = from.at.point;
    hit.normal = from.normal;
    hit.overlap = overlap;
    hit.share = share;
    hit.triangle = from.triangle;
    for (int k = 0; k < 3; ++k) hit.weight[k] = from.at.weight[k];
  }

  FURROW_HD int share_out(const Candidate* found, int size, const Vector& centre, double radius, FacetHit* out) const {
    constexpr double kFadeFrom = 0.4, kFadeTo = 0.5;
    const double deepest = radius - found[0].distance;
    const double fade = within((kFadeTo - deepest / radius) / (kFadeTo - kFadeFrom), 0.0, 1.0);
    Vector normal[kCandidates];
    double depth[kCandidates], faded[kCandidates], shared[kCandidates], lambda[kCandidates];
    int source[kCandidates], count = 0;
    for (int i = 0; i < size; ++i) {
      const Candidate& one = found[i];
      const double own_fade = i == 0 ? 1.0 : fade;
      const bool far_side =
          i > 0 && one.at.region == Region::face && dot(one.normal, centre) < plane[one.triangle].offset;
      if (far_side || !(own_fade > 0.0)) continue;
      normal[count] = one.normal;
      depth[count] = radius - one.distance;
      faded[count] = own_fade * depth[count];
      source[count] = i;
      ++count;
    }
    if (push_out(normal, faded, count, lambda) > 1)
      share_depth(normal, depth, count, shared);
    else
      for (int i = 0; i < count; ++i) shared[i] = depth[i];
    int written = 0;
    for (int i = 0; i < count && written < kHits; ++i)
      if (lambda[i] > 0.0) write(out[written++], found[source[i]], shared[i], lambda[i] / shared[i]);
    return written;
  }

  /// Touched points of a sphere, the deepest first. @param listed  triangles that it may touch
  FURROW_HD int hits(const Vector& centre, double radius, const i32* listed, i32 count, FacetHit* out) const {
    i32 first = 0;
    while (first < count && off_plane(listed[first], centre, radius)) ++first;
    if (first == count) return 0;
    Candidate found[kCandidates];
    int size = 0;
    for (i32 k = first; k < count; ++k)
      if (!off_plane(listed[k], centre, radius)) consider(listed[k], centre, radius, found, size);
    if (size == 0) return 0;
    const Candidate& nearest = found[0];
    if (behind(nearest, centre)) {
      write(out[0], nearest, radius + nearest.distance, 1.0);
      if (nearest.at.region != Region::face && nearest.distance > kSamePoint * radius)
        out[0].normal = opposite(nearest.normal);
      return 1;
    }
    if (size == 1) {
      write(out[0], nearest, radius - nearest.distance, 1.0);
      return 1;
    }
    return share_out(found, size, centre, radius, out);
  }
};

// ---- couples on a surface (terrain/surface/surface_patches.hpp) -------------------------------------------------

/// A symmetric matrix.
struct Symmetric {
  double xx, yy, zz, xy, xz, yz;
  FURROW_HD Vector times(const Vector& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// Inverse of a positive semidefinite matrix on the axes along which it is not zero, by Jacobi's rotations.
FURROW_HD inline Symmetric pseudo_inverse(const Symmetric& m) {
  constexpr double kNothing = 4.0 * 2.220446049250313e-16;
  double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < 12; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0.0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double bounded = within(theta, -1e150, 1e150);
        const double t = (bounded < 0.0 ? -1.0 : 1.0) / (size_of(bounded) + simd::root(bounded * bounded + 1.0));
        const double c = 1.0 / simd::root(t * t + 1.0), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const double x = v[k][p], y = v[k][q];
          v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
        }
      }
  const double largest = most(a[0][0], most(a[1][1], a[2][2]));
  Symmetric out{0, 0, 0, 0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    if (!(a[k][k] > kNothing * largest)) continue;
    const double by = 1.0 / a[k][k];
    out.xx += by * (v[0][k] * v[0][k]), out.yy += by * (v[1][k] * v[1][k]), out.zz += by * (v[2][k] * v[2][k]);
    out.xy += by * (v[0][k] * v[1][k]), out.xz += by * (v[0][k] * v[2][k]), out.yz += by * (v[1][k] * v[2][k]);
  }
  return out;
}

/// The vertices of a triangle's patch at their present positions.
struct Patch {
  Vector centre, spin;  // m, rad/s
  Symmetric inverse;    // 1/m²
};

struct Patches {
  const i32 *first, *vertex;
  const Vector *position, *velocity;

  FURROW_HD Vector moment_of(i32 t, const Patch& patch, const Vector& turn) const {
    Vector moment{0, 0, 0};
    for (i32 k = first[t]; k < first[t + 1]; ++k) {
      const Vector x = position[vertex[k]] - patch.centre;
      moment = moment + cross(x, cross(turn, x));
    }
    return moment;
  }
  /// J⁻¹ b, with one step of iterative refinement.
  FURROW_HD Vector solved(i32 t, const Patch& patch, const Vector& b) const {
    const Vector once = patch.inverse.times(b);
    return once + patch.inverse.times(b - moment_of(t, patch, once));
  }
  FURROW_HD Patch of(i32 t) const {
    Patch patch{{0, 0, 0}, {0, 0, 0}, {0, 0, 0, 0, 0, 0}};
    const i32 count = first[t + 1] - first[t];
    for (i32 k = first[t]; k < first[t + 1]; ++k) patch.centre = patch.centre + position[vertex[k]];
    patch.centre = (1.0 / count) * patch.centre;
    Symmetric j{0, 0, 0, 0, 0, 0};
    Vector circulation{0, 0, 0};
    for (i32 k = first[t]; k < first[t + 1]; ++k) {
      const Vector x = position[vertex[k]] - patch.centre;
      const double square = dot(x, x);
      j.xx += square - x.x * x.x, j.yy += square - x.y * x.y, j.zz += square - x.z * x.z;
      j.xy -= x.x * x.y, j.xz -= x.x * x.z, j.yz -= x.y * x.z;
      circulation = circulation + cross(x, velocity[vertex[k]]);
    }
    patch.inverse = pseudo_inverse(j);
    patch.spin = solved(t, patch, circulation);
    return patch;
  }
};

}  // namespace furrow::terrain::gpu
