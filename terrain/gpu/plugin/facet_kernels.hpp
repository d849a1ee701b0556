// Contacts of grains with the moving surfaces of tires: one thread evaluates all touched points of one grain on one
// surface. Forces on the vertices are added as whole numbers, so that their sums do not depend on an order.
//
// History is stored per grain and surface; a touched point takes over that of the earlier point with the nearest normal
// (terrain/dem/tires/surface_contacts.hpp).
#pragma once

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/gpu/plugin/grain_data.hpp"
#include "terrain/gpu/plugin/measure.hpp"
#include "terrain/gpu/plugin/patches.hpp"
#include "terrain/gpu/plugin/wall_kernel.hpp"

namespace furrow::terrain::gpu {

struct FacetSpring {
  double normal[3], t[3], root, r[3];  // -, N, √m, N m
};

struct FacetGridView {
  Vector origin;
  double inverse_cell;
  i32 cells[3];
  const i32 *first, *entry, *listed;
  i32 listed_count;
};

/// One surface on the device.
struct SurfaceView {
  Facets facets;
  Patches patches;
  Vector *position, *velocity;
  const Vector *start, *end;
  FacetPlane* plane;
  Patch* patch;
  FacetGridView grid;
  i64* impulse;  // [vertex * 3 + axis], on the surface, 2^−50 N s
  // Of each entry, a grain near the surface:
  const u32* grain;
  FacetSpring* spring;  // [entry * kMaxSurfaceHits + point]
  u32* touched;         // points, and how many of them slide, times 2^16
  i64* sums;            // [entry * kFacetSums + sum], 2^−50 N s and N m s
};
/// Impulse along and across the normals, moment of the vertices less that of the contacts, scales of both.
inline constexpr int kFacetSums = 11;

struct MoveVertexKernel {
  SurfaceView s;
  double share;
  const Control* control;
  FURROW_HD void operator()(int v) const {
    if (control->stop) return;
    s.position[v] = share == 1.0 ? s.end[v] : s.start[v] + share * (s.end[v] - s.start[v]);
  }
};

struct PlaneKernel {
  SurfaceView s;
  const Control* control;
  bool rolls;
  FURROW_HD void operator()(int k) const {
    if (control->stop) return;
    const i32 t = s.grid.listed[k];
    s.plane[t] = s.facets.plane_of(t);
    if (rolls) s.patch[t] = s.patches.of(t);
  }
};

/// Spin of a triangle about n: half the circulation of its vertices' velocities over its area.
FURROW_HD inline double spin_about(const SurfaceView& s, i32 triangle, const Vector& n) {
  const i32* const t = s.facets.corners(triangle);
  const Vector twice = s.facets.twice_area(triangle);
  const double area2 = length(twice);
  if (area2 == 0.0) return 0.0;
  double circulation = 0.0;
  for (int k = 0; k < 3; ++k) {
    const i32 a = t[k], b = t[(k + 1) % 3];
    circulation += 0.5 * dot(s.velocity[a] + s.velocity[b], s.position[b] - s.position[a]);
  }
  return circulation / area2 * (dot(twice, n) / area2);
}

template <class Law>
struct FacetParams {
  typename Law::template Coefficients<double> c;
  double radius, dt, kick;
};

/// Points of one grain on a surface.
struct Touches {
  FacetHit hit[kMaxSurfaceHits];
  int count;
};
FURROW_HD inline void find_touches(const SurfaceView& s, const Vector& centre, double radius, Touches& out) {
  out.count = 0;
  const Vector at = s.grid.inverse_cell * (centre - s.grid.origin);
  const i32* const n = s.grid.cells;
  if (!(at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0 && at.x < n[0] && at.y < n[1] && at.z < n[2])) return;
  const i64 cell = (static_cast<i64>(at.x) * n[1] + static_cast<i64>(at.y)) * n[2] + static_cast<i64>(at.z);
  const i32 from = s.grid.first[cell], to = s.grid.first[cell + 1];
  out.count = s.facets.hits(centre, radius, s.grid.entry + from, to - from, out.hit);
}

/// Motion of a grain at a touched point.
FURROW_HD inline dem::ContactMotion<double> motion_at(const SurfaceView& s, bool rolls, const FacetHit& hit,
                                                      const Vector& arm, const Motion& m) {
  dem::ContactMotion<double> motion = dem::motion_on_surface(hit.normal, hit.overlap, arm, triple(m.v), triple(m.w));
  const i32* const t = s.facets.corners(hit.triangle);
  motion.velocity = motion.velocity - (hit.weight[0] * s.velocity[t[0]] + hit.weight[1] * s.velocity[t[1]] +
                                       hit.weight[2] * s.velocity[t[2]]);
  motion.spin += 0.5 * spin_about(s, hit.triangle, hit.normal);
  if (rolls) motion.roll = motion.roll - s.patch[hit.triangle].spin;
  return motion;
}

/// The earlier point with the nearest normal, within 60°; −1 if there is none.
FURROW_HD inline int past_point(const FacetSpring* old, int count, const Vector& n) {
  int best = -1;
  double cosine = 0.5;
  for (int k = 0; k < count; ++k) {
    const double c = dot(triple(old[k].normal), n);
    if (c > cosine) cosine = c, best = k;
  }
  return best;
}

template <class Law, bool kRolling>
struct FacetKernel {
  Pointers g;
  SurfaceView s;
  FacetParams<Law> p;

  FURROW_HD void push(i32 vertex, const Vector& force, Vector& nodal_moment, const Vector& about) const {
    const Vector impulse = p.kick * force;
    i64* const to = s.impulse + 3 * static_cast<i64>(vertex);
    atomic_add(to, nearest(kPerImpulse * impulse.x));
    atomic_add(to + 1, nearest(kPerImpulse * impulse.y));
    atomic_add(to + 2, nearest(kPerImpulse * impulse.z));
    nodal_moment = nodal_moment + cross(s.position[vertex] - about, force);
  }
  FURROW_HD void count(int e, int first, const Vector& v) const {
    i64* const to = s.sums + static_cast<i64>(e) * kFacetSums + first;
    to[0] += nearest(kPerImpulse * (p.kick * v.x));
    to[1] += nearest(kPerImpulse * (p.kick * v.y));
    to[2] += nearest(kPerImpulse * (p.kick * v.z));
  }

  FURROW_HD void operator()(int e) const {
    if (g.control->stop) return;
    const u32 i = s.grain[e];
    const Vector centre = g.position(static_cast<int>(i));
    Touches touches;
    find_touches(s, centre, p.radius, touches);
    const int old_count = static_cast<int>(s.touched[e] & 0xffffU);
    u32 sliding = 0;
    FacetSpring old[kMaxSurfaceHits];
    FacetSpring* const spring = s.spring + static_cast<i64>(e) * kMaxSurfaceHits;
    if (touches.count > 0)
      for (int k = 0; k < old_count; ++k) old[k] = spring[k];
    for (int h = 0; h < touches.count; ++h) {
      const FacetHit& hit = touches.hit[h];
      const Motion& m = g.motion[i];
      const Vector arm = hit.point - centre;
      const bool rolls = kRolling && p.c.rolling_arm > 0.0;
      const dem::ContactMotion<double> motion = motion_at(s, rolls, hit, arm, m);
      dem::ContactHistory<double> history{{0, 0, 0}, 0.0, {0, 0, 0}};
      if (const int past = past_point(old, old_count, hit.normal); past >= 0)
        history = {triple(old[past].t), old[past].root, triple(old[past].r)};
      const dem::ContactForce<double> f = Law::template force<kRolling>(p.c, p.dt, motion, history);
      FacetSpring next;
      set(next.normal, motion.normal);
      set(next.t, history.tangential);
      next.root = history.root_overlap;
      set(next.r, history.rolling);
      spring[h] = next;
      const dem::FacetLoads<double> loads = dem::facet_loads(f, motion.normal, arm, hit.share);
      add(g.load[i].f, loads.push + loads.drag);
      add(g.load[i].t, loads.torque);

      const Vector total = -1.0 * (loads.push + loads.drag);
      Vector nodal_moment{0, 0, 0}, moment{0, 0, 0};
      const i32* const t = s.facets.corners(hit.triangle);
      for (int k = 0; k < 3; ++k) push(t[k], hit.weight[k] * total, nodal_moment, hit.point);
      if (rolls) {
        const Patch& patch = s.patch[hit.triangle];
        moment = (-hit.share) * f.rolling;
        const Vector turn = s.patches.solved(hit.triangle, patch, moment);
        for (i32 k = s.patches.first[hit.triangle]; k < s.patches.first[hit.triangle + 1]; ++k) {
          const i32 v = s.patches.vertex[k];
          push(v, cross(turn, s.position[v] - patch.centre), nodal_moment, hit.point);
        }
      }
      count(e, 0, -1.0 * loads.push);
      count(e, 3, -1.0 * loads.drag);
      count(e, 6, nodal_moment - moment);
      i64* const scale = s.sums + static_cast<i64>(e) * kFacetSums + 9;
      scale[0] += nearest(kPerImpulse * (p.kick * length(total)));
      scale[1] += nearest(kPerImpulse * (p.kick * (length(total) * p.radius + length(moment))));
      const double limit = 0.99 * p.c.friction * f.elastic;
      if (dot(f.tangential, f.tangential) >= limit * limit) ++sliding;
      atomic_max(&g.control->overlap, bits_of(static_cast<float>(hit.overlap)));
    }
    s.touched[e] = static_cast<u32>(touches.count) | sliding << 16;
  }
};

/// Marks grains in a box.
struct InBoxKernel {
  Pointers g;
  Vector low, high;
  u32* flag;
  FURROW_HD void operator()(int i) const {
    const Vector x = g.position(i);
    flag[i] = x.x > low.x && x.y > low.y && x.z > low.z && x.x < high.x && x.y < high.y && x.z < high.z ? 1 : 0;
  }
};

/// @param order  old place of each grain; null: as before
struct CarryFacetsKernel {
  const u32 *order, *old_entry_of, *grain;
  const FacetSpring* from;
  const u32* from_touched;
  FacetSpring* to;
  u32* to_touched;
  i64* sums;
  FURROW_HD void operator()(int e) const {
    const u32 g = grain[e], old = old_entry_of ? old_entry_of[order ? order[g] : g] : ~0U;
    const u32 touched = old == ~0U ? 0 : from_touched[old];
    to_touched[e] = touched;
    for (u32 k = 0; k < (touched & 0xffffU); ++k)
      to[static_cast<i64>(e) * kMaxSurfaceHits + k] = from[static_cast<i64>(old) * kMaxSurfaceHits + k];
    for (int k = 0; k < kFacetSums; ++k) sums[static_cast<i64>(e) * kFacetSums + k] = 0;
  }
};

/// Sums of whole numbers over pieces of the entries: `width` numbers per entry.
struct AddPiecesKernel {
  static constexpr i64 kPiece = 64;
  const i64* from;
  i64 count;
  i32 width;
  i64* to;  // [piece * width + number]
  FURROW_HD void operator()(int k) const {
    const i64 piece = k / width, number = k % width, begin = piece * kPiece;
    const i64 end = begin + kPiece < count ? begin + kPiece : count;
    i64 sum = 0;
    for (i64 e = begin; e < end; ++e) sum += from[e * width + number];
    to[k] = sum;
  }
};

// ---- measured, not stepped --------------------------------------------------------------------------------------

template <class Law, bool kRolling>
struct MeasureFacetsKernel {
  Pointers g;
  SurfaceView s;
  FacetParams<Law> p;
  Measured* to;
  bool losses;

  FURROW_HD void operator()(int e) const {
    const u32 i = s.grain[e];
    const Vector centre = g.position(static_cast<int>(i));
    Touches touches;
    find_touches(s, centre, p.radius, touches);
    const int old_count = static_cast<int>(s.touched[e] & 0xffffU);
    const FacetSpring* const old = s.spring + static_cast<i64>(e) * kMaxSurfaceHits;
    Measured& sums = to[g.low[i].id];
    u32 taken = 0;
    for (int h = 0; h < touches.count; ++h) {
      const FacetHit& hit = touches.hit[h];
      const Vector arm = hit.point - centre;
      const dem::ContactMotion<double> motion = motion_at(s, kRolling && p.c.rolling_arm > 0.0, hit, arm, g.motion[i]);
      dem::ContactHistory<double> history{{0, 0, 0}, 0.0, {0, 0, 0}};
      if (const int past = past_point(old, old_count, hit.normal); past >= 0) {
        history = {triple(old[past].t), old[past].root, triple(old[past].r)};
        taken |= 1U << past;
      }
      sums.template add_contact<Law, kRolling>(p.c, p.dt, motion, history, hit.share, losses);
    }
    if (!losses) return;
    for (int k = 0; k < old_count; ++k)
      if (!(taken >> k & 1U))
        sums.losses[4] += held_energy<Law>(p.c, {triple(old[k].t), old[k].root, triple(old[k].r)}) / p.dt;
  }
};

struct HardFacetsKernel {
  Pointers g;
  SurfaceView s;
  HardFinder find;
  u32 surface;

  FURROW_HD void operator()(int e) const {
    const u32 i = s.grain[e];
    const Vector centre = g.position(static_cast<int>(i));
    Touches touches;
    find_touches(s, centre, find.radius, touches);
    for (int h = 0; h < touches.count; ++h) {
      const FacetHit& hit = touches.hit[h];
      if (!(hit.overlap > find.above)) continue;
      const i32* const t = s.facets.corners(hit.triangle);
      const Vector surface_v =
          hit.weight[0] * s.velocity[t[0]] + hit.weight[1] * s.velocity[t[1]] + hit.weight[2] * s.velocity[t[2]];
      find.add(hit.overlap, dot(triple(g.motion[i].v) - surface_v, hit.normal), g.low[i].id, surface, 2);
    }
  }
};

}  // namespace furrow::terrain::gpu
