// Forces between grains: each thread sums the contacts of one grain in the order of its neighbours' numbers. Both
// grains of a pair evaluate it. The exact difference of their positions, and all that follows from it, only changes its
// sign. So momentum is conserved to the round-off of double, and both keep the same springs.
#pragma once

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/gpu/plugin/grain_data.hpp"

namespace furrow::terrain::gpu {

namespace dem = furrow::terrain::dem;

/// Distance from a neighbour of a list, u.
struct Between {
  i32 x, y, z;
  FURROW_HD u64 square() const {
    const i64 a = x, b = y, c = z;
    return static_cast<u64>(a * a) + static_cast<u64>(b * b) + static_cast<u64>(c * c);
  }
};

FURROW_HD inline Between between(const Low& a, const Low& b, u32 image, const Images& images) {
  return {static_cast<i32>(a.x - b.x + images.x[image % 3]), static_cast<i32>(a.y - b.y + images.y[image / 3]),
          static_cast<i32>(a.z - b.z)};
}

template <class Law>
struct PairParams {
  typename Law::template Coefficients<float> coefficients;
  u64 diameter2;                    // D², u²
  float diameter, unit, unit2, dt;  // m, m, m², s
  Images images;
};

/// Sets normal, overlap and relative motion of grain i and its neighbour. @pre they touch
FURROW_HD inline dem::ContactMotion<float> pair_motion(const Between& at, u64 diameter2, float diameter, float unit,
                                                       float unit2, const MotionRow& i, const MotionRow& j,
                                                       Triple<float>& d) {
  d = {unit * static_cast<float>(at.x), unit * static_cast<float>(at.y), unit * static_cast<float>(at.z)};
  const float gap = unit2 * static_cast<float>(static_cast<i64>(diameter2 - at.square()));
  dem::ContactMotion<float> m;
  dem::set_pair_overlap(m, d, gap, diameter);
  const Triple<float> w_i = triple(i.w), w_j = triple(j.w);
  dem::RelativeMotion<float> relative;
  relative.dv = triple(i.v) - triple(j.v);
  relative.turn = w_i + w_j;
  relative.roll = w_i - w_j;
  relative.delta = 0.0F;
  dem::set_pair_velocity<false>(m, d, relative);
  m.roll = relative.roll;
  return m;
}

template <class Law, bool kRolling>
struct PairKernel {
  Pointers g;
  PairParams<Law> p;

  FURROW_HD void operator()(int i) const {
    if (g.control->stop) return;
    const Low own = g.low[i];
    const MotionRow row = g.row[i];
    Triple<double> force{0.0, 0.0, 0.0}, torque{0.0, 0.0, 0.0};
    const u32 before = g.touching[i], count = g.listed[i];
    u32 now = 0;
    float deepest = 0.0F;
    for (u32 k = 0; k < count; ++k) {
      const i64 place = k * g.stride + i;
      const u32 entry = g.list[place], j = entry & kPlaceMask;
      const Between at = between(own, g.low[j], entry >> kSlotBits, p.images);
      if (at.square() >= p.diameter2) continue;
      Triple<float> d;
      const dem::ContactMotion<float> m = pair_motion(at, p.diameter2, p.diameter, p.unit, p.unit2, row, g.row[j], d);
      dem::ContactHistory<float> history{{0, 0, 0}, 0, {0, 0, 0}};
      if constexpr (Law::kHistory) {
        if (before >> k & 1U) {
          const SpringRow t = g.spring[place];
          history.tangential = {t.x, t.y, t.z};
          history.root_overlap = t.w;
          if constexpr (kRolling) {
            const SpringRow r = g.roll[place];
            history.rolling = {r.x, r.y, r.z};
          }
        }
      }
      const dem::ContactForce<float> f = Law::template force<kRolling>(p.coefficients, p.dt, m, history);
      if constexpr (Law::kHistory) {
        g.spring[place] = {history.tangential.x, history.tangential.y, history.tangential.z, history.root_overlap};
        if constexpr (kRolling) g.roll[place] = {history.rolling.x, history.rolling.y, history.rolling.z, 0.0F};
      }
      now |= 1U << k;
      const dem::PairLoads<float> loads = dem::pair_loads<false>(f, m.normal, d, 0.0F);
      force = force + Triple<double>{loads.force.x, loads.force.y, loads.force.z};
      torque = torque + (Triple<double>{loads.torque.x, loads.torque.y, loads.torque.z} +
                         Triple<double>{loads.couple.x, loads.couple.y, loads.couple.z});
      deepest = simd::larger(deepest, m.overlap);
    }
    g.touching[i] = now;
    set(g.load[i].f, force);
    set(g.load[i].t, torque);
    if (deepest > 0.0F) atomic_max(&g.control->overlap, bits_of(deepest));
  }
};

}  // namespace furrow::terrain::gpu
