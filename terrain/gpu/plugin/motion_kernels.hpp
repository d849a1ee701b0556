// Moves the grains, and decides after each step whether the next one may begin.
#pragma once

#include "terrain/gpu/plugin/grain_data.hpp"

namespace furrow::terrain::gpu {

struct MoveKernel {
  Pointers g;
  double per_mass, per_inertia, kick, keep, dt;  // keep: share of the motion that drag leaves
  double gravity[3];
  double longest;  // a grain that moves farther in a step is lost, u

  FURROW_HD void operator()(int i) const {
    if (g.control->stop) return;
    const Load load = g.load[i];
    Motion m = g.motion[i];
    Low l = g.low[i];
    const Low from = g.built[i];
    double speed2 = 0.0;
    u32* const low[3] = {&l.x, &l.y, &l.z};
    i32* const high[3] = {&g.high[i].x, &g.high[i].y, &g.high[i].z};
    bool lost = false;
    for (int k = 0; k < 3; ++k) {
      m.v[k] = (m.v[k] + kick * (load.f[k] * per_mass + gravity[k])) * keep;
      m.w[k] = (m.w[k] + kick * (load.t[k] * per_inertia)) * keep;
      speed2 += m.v[k] * m.v[k];
      const double way = dt * m.v[k] * g.per_unit;
      if (!(way < longest && way > -longest) || !(m.w[k] - m.w[k] == 0.0)) {
        lost = true;
        continue;
      }
      const i64 to = static_cast<i64>(*low[k]) + nearest(way);
      *low[k] = static_cast<u32>(to);
      if (const i64 carry = to >> 32; carry != 0) *high[k] += static_cast<i32>(carry);
    }
    if (lost) {
      atomic_min(&g.control->lost, l.id);
      return;
    }
    g.motion[i] = m;
    g.low[i] = l;
    MotionRow row;
    for (int k = 0; k < 3; ++k) row.v[k] = static_cast<float>(m.v[k]), row.w[k] = static_cast<float>(m.w[k]);
    row.unused[0] = row.unused[1] = 0.0F;
    g.row[i] = row;
    const i64 x = static_cast<i32>(l.x - from.x), y = static_cast<i32>(l.y - from.y),
              z = static_cast<i32>(l.z - from.z);
    atomic_max(&g.control->travel2, static_cast<u64>(x * x) + static_cast<u64>(y * y) + static_cast<u64>(z * z));
    atomic_max(&g.control->speed2, bits_of(static_cast<float>(speed2)));
  }
};

/// One thread. A contact with overlap δ when the forces were evaluated has at most δ + dt (v_i + v_j) in the next step.
struct ControlKernel {
  Control* control;
  u64 farthest2;             // half a skin, u²
  double dt, surface_speed;  // of the next step, s; of the fastest vertex, m/s
  double most;               // overlap, m; infinite: no limit

  FURROW_HD void operator()(int) const {
    Control& c = *control;
    if (c.stop) return;
    ++c.done;
    float overlap, speed2;
    memcpy(&overlap, &c.overlap, sizeof overlap);
    memcpy(&speed2, &c.speed2, sizeof speed2);
    const double speed = simd::root(static_cast<double>(speed2));
    const double next = static_cast<double>(overlap) + dt * (speed + (speed > surface_speed ? speed : surface_speed));
    if (c.overlap > c.deepest) c.deepest = c.overlap;
    c.last_overlap = c.overlap, c.last_speed2 = c.speed2;
    c.overlap = c.speed2 = 0;
    if (c.lost != ~0U) c.stop |= kStopLost;
    if (c.travel2 > farthest2) c.stop |= kStopLists;
    if (!(next <= most)) c.stop |= kStopOverlap;
  }
};

}  // namespace furrow::terrain::gpu
