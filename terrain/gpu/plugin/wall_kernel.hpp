// Forces of the bin on the grains near its walls: one thread evaluates all walls of one grain, in double precision.
#pragma once

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/gpu/plugin/grain_data.hpp"

namespace furrow::terrain::gpu {

namespace dem = furrow::terrain::dem;

/// History with one wall; all zero while apart.
struct WallSpring {
  double t[3], root, r[3];  // N, √m, N m
};

/// Impulses are whole numbers of 2^−50 N s, so that their sum does not depend on an order.
inline constexpr double kPerImpulse = 1125899906842624.0;

struct WallPointers {
  i32 count;
  u32* grain;          // place of each grain near a wall
  WallSpring* spring;  // [entry * kWalls + wall]
  i64* impulse;        // [entry * 3 + axis], on the grain
  double* floor;       // vertical force of the floor, N
};

FURROW_HD inline double distance_from(const dem::Bin& bin, int wall, const Triple<double>& x) {
  return wall == 0   ? x.x
         : wall == 1 ? bin.length - x.x
         : wall == 2 ? x.y + 0.5 * bin.width
         : wall == 3 ? 0.5 * bin.width - x.y
                     : x.z;
}
FURROW_HD inline Triple<double> wall_normal(int wall) {
  return {wall == 0 ? 1.0 : wall == 1 ? -1.0 : 0.0, wall == 2 ? 1.0 : wall == 3 ? -1.0 : 0.0, wall == 4 ? 1.0 : 0.0};
}
FURROW_HD inline bool has_wall(const dem::Bin& bin, int wall) {
  return wall == dem::kFloor || !(wall < 2 ? bin.periodic_x : bin.periodic_y);
}
FURROW_HD inline dem::ContactHistory<double> history_of(const WallSpring& s) {
  return {triple(s.t), s.root, triple(s.r)};
}

template <class Law>
struct WallParams {
  typename Law::template Coefficients<double> floor, side;
  dem::Bin bin;
  double radius, dt, kick;
};

template <class Law, bool kRolling>
struct WallKernel {
  Pointers g;
  WallPointers w;
  WallParams<Law> p;

  FURROW_HD void operator()(int e) const {
    if (g.control->stop) return;
    const u32 i = w.grain[e];
    const Triple<double> x = g.position(static_cast<int>(i));
    double floor = 0.0;
    for (int wall = 0; wall < dem::kWalls; ++wall) {
      if (!has_wall(p.bin, wall)) continue;
      const double distance = distance_from(p.bin, wall, x), overlap = p.radius - distance;
      WallSpring& s = w.spring[e * dem::kWalls + wall];
      if (!(overlap > 0.0)) {
        if (s.root > 0.0) s = WallSpring{};
        continue;
      }
      if (distance < 0.0) atomic_min(&g.control->lost, g.low[i].id);
      const Motion& m = g.motion[i];
      const dem::WallPoint<double> at =
          dem::point_on_wall(wall_normal(wall), distance, overlap, triple(m.v), triple(m.w));
      dem::ContactHistory<double> history = history_of(s);
      const dem::ContactForce<double> f =
          Law::template force<kRolling>(wall == dem::kFloor ? p.floor : p.side, p.dt, at.motion, history);
      if constexpr (Law::kHistory) {
        set(s.t, history.tangential);
        s.root = history.root_overlap;
        if constexpr (kRolling) set(s.r, history.rolling);
      }
      const dem::SurfaceLoads<double> loads = dem::wall_loads(f, at);
      add(g.load[i].f, loads.force);
      add(g.load[i].t, loads.torque);
      w.impulse[3 * e] += nearest(kPerImpulse * (p.kick * loads.force.x));
      w.impulse[3 * e + 1] += nearest(kPerImpulse * (p.kick * loads.force.y));
      w.impulse[3 * e + 2] += nearest(kPerImpulse * (p.kick * loads.force.z));
      if (wall == dem::kFloor) floor = loads.force.z;
      atomic_max(&g.control->overlap, bits_of(static_cast<float>(overlap)));
    }
    w.floor[e] = floor;
  }
};

}  // namespace furrow::terrain::gpu
