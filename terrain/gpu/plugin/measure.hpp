// Sums over grains and contacts at their present positions, and the deepest contacts. Nothing is stepped: histories are
// read, not written. Each grain's share is written to its number's place, and the places are summed in pieces of a
// fixed length, so that the sums depend on the state alone.
#pragma once

#include "terrain/gpu/plugin/pair_kernel.hpp"
#include "terrain/gpu/plugin/wall_kernel.hpp"

namespace furrow::terrain::gpu {

/// Energy in the springs of a contact that ended, J.
template <class Law>
FURROW_HD double held_energy(const typename Law::template Coefficients<double>& c,
                             const dem::ContactHistory<double>& history) {
  return Law::held(c, 0.0, history).tangential;
}

/// A grain's share of the sums.
struct Measured {
  double speed2, spin2, speed[3], place[3];
  double elastic, contacts, contact_force, net_force, cohesion, tangential;
  double losses[5];
  double floor;   // vertical force of the floor in the last step, N
  double listed;  // pairs
  double net[3];  // force on the grain, N

  static constexpr int kNumbers = 24;

  template <class T>
  FURROW_HD void add_sample(const dem::ContactSampleOf<T>& one, double share) {
    losses[0] += share * static_cast<double>(one.power.sliding);
    losses[1] += share * static_cast<double>(one.power.normal_damping);
    losses[2] += share * static_cast<double>(one.power.tangential_damping);
    losses[3] += share * static_cast<double>(one.power.rolling);
    losses[4] += share * static_cast<double>(one.power.opening);
    cohesion += share * static_cast<double>(one.stored.cohesion);
    tangential += share * static_cast<double>(one.stored.tangential);
  }
  /// Adds `share` of a contact with a wall or a surface. @returns the force on the grain
  template <class Law, bool kRolling>
  FURROW_HD Triple<double> add_contact(const typename Law::template Coefficients<double>& c, double dt,
                                       const dem::ContactMotion<double>& motion,
                                       const dem::ContactHistory<double>& history, double share, bool with_losses) {
    if (with_losses) {
      add_sample(Law::template sample<kRolling>(c, dt, motion, history), share);
    } else {
      const dem::Stored stored = Law::held(c, motion.overlap, history);
      cohesion += share * stored.cohesion;
      tangential += share * stored.tangential;
    }
    dem::ContactHistory<double> copy = history;
    const dem::ContactForce<double> f = Law::template force<kRolling>(c, dt, motion, copy);
    const Triple<double> force = share * (f.normal * motion.normal + f.tangential);
    elastic += share * f.energy;
    contacts += 1.0;
    contact_force += simd::root(dot(force, force));
    add(net, force);
    return force;
  }
};
static_assert(sizeof(Measured) == Measured::kNumbers * sizeof(double));

template <class Law, bool kRolling>
struct MeasurePairsKernel {
  Pointers g;
  PairParams<Law> p;
  typename Law::template Coefficients<double> c;
  Measured* to;
  bool losses;

  FURROW_HD void operator()(int i) const {
    const Low own = g.low[i];
    const MotionRow row = g.row[i];
    const Motion& m = g.motion[i];
    Measured sums{};
    sums.speed2 = m.v[0] * m.v[0] + m.v[1] * m.v[1] + m.v[2] * m.v[2];
    sums.spin2 = m.w[0] * m.w[0] + m.w[1] * m.w[1] + m.w[2] * m.w[2];
    for (int k = 0; k < 3; ++k) sums.speed[k] = m.v[k];
    set(sums.place, g.position(i));
    const u32 before = g.touching[i], count = g.listed[i];
    sums.listed = 0.5 * count;
    for (u32 k = 0; k < count; ++k) {
      const i64 place = k * g.stride + i;
      const u32 entry = g.list[place], j = entry & kPlaceMask;
      dem::ContactHistory<float> history{{0, 0, 0}, 0, {0, 0, 0}};
      const bool touched = before >> k & 1U;
      if constexpr (Law::kHistory)
        if (touched) {
          const SpringRow t = g.spring[place];
          history.tangential = {t.x, t.y, t.z};
          history.root_overlap = t.w;
          if constexpr (kRolling) {
            const SpringRow r = g.roll[place];
            history.rolling = {r.x, r.y, r.z};
          }
        }
      const dem::ContactHistory<double> old{{history.tangential.x, history.tangential.y, history.tangential.z},
                                            history.root_overlap,
                                            {history.rolling.x, history.rolling.y, history.rolling.z}};
      const Between at = between(own, g.low[j], entry >> kSlotBits, p.images);
      if (at.square() >= p.diameter2) {
        if (losses && touched) sums.losses[4] += 0.5 * held_energy<Law>(c, old) / static_cast<double>(p.dt);
        continue;
      }
      Triple<float> d;
      const dem::ContactMotion<float> motion =
          pair_motion(at, p.diameter2, p.diameter, p.unit, p.unit2, row, g.row[j], d);
      if (losses) {
        sums.add_sample(Law::template sample<kRolling>(p.coefficients, p.dt, motion, history), 0.5);
      } else {
        const dem::Stored stored = Law::held(c, motion.overlap, old);
        sums.cohesion += 0.5 * stored.cohesion;
        sums.tangential += 0.5 * stored.tangential;
      }
      const dem::ContactForce<float> f = Law::template force<kRolling>(p.coefficients, p.dt, motion, history);
      const Triple<float> force = f.normal * motion.normal + f.tangential;
      sums.elastic += 0.5 * static_cast<double>(f.energy);
      sums.contacts += 0.5;
      sums.contact_force += 0.5 * static_cast<double>(simd::root(dot(force, force)));
      add(sums.net, {force.x, force.y, force.z});
    }
    to[own.id] = sums;
  }
};

template <class Law, bool kRolling>
struct MeasureWallsKernel {
  Pointers g;
  WallPointers w;
  WallParams<Law> p;
  Measured* to;
  bool losses;

  FURROW_HD void operator()(int e) const {
    const u32 i = w.grain[e];
    const Triple<double> x = g.position(static_cast<int>(i));
    Measured& sums = to[g.low[i].id];
    sums.floor = w.floor[e];
    for (int wall = 0; wall < dem::kWalls; ++wall) {
      if (!has_wall(p.bin, wall)) continue;
      const double distance = distance_from(p.bin, wall, x), overlap = p.radius - distance;
      const auto& c = wall == dem::kFloor ? p.floor : p.side;
      const dem::ContactHistory<double> history = history_of(w.spring[e * dem::kWalls + wall]);
      if (!(overlap > 0.0)) {
        if (losses && history.root_overlap > 0.0) sums.losses[4] += held_energy<Law>(c, history) / p.dt;
        continue;
      }
      const Motion& m = g.motion[i];
      const dem::WallPoint<double> at =
          dem::point_on_wall(wall_normal(wall), distance, overlap, triple(m.v), triple(m.w));
      sums.template add_contact<Law, kRolling>(c, p.dt, at.motion, history, 1.0, losses);
    }
  }
};

/// Sets the net force of each grain from the force on it.
struct NetForceKernel {
  Measured* of;
  double weight[3];
  FURROW_HD void operator()(int id) const {
    Measured& m = of[id];
    const Triple<double> net = triple(m.net) + triple(weight);
    m.net_force = simd::root(dot(net, net));
  }
};

/// Sums pieces of the grains' shares.
struct AddMeasuredKernel {
  static constexpr i64 kPiece = 32;
  const Measured* from;
  i64 count;
  Measured* to;
  FURROW_HD void operator()(int piece) const {
    const i64 begin = piece * kPiece, end = begin + kPiece < count ? begin + kPiece : count;
    double sums[Measured::kNumbers] = {};
    for (i64 e = begin; e < end; ++e) {
      const double* const one = reinterpret_cast<const double*>(from + e);
      for (int k = 0; k < Measured::kNumbers; ++k) sums[k] += one[k];
    }
    double* const out = reinterpret_cast<double*>(to + piece);
    for (int k = 0; k < Measured::kNumbers; ++k) out[k] = sums[k];
  }
};

// ---- the deepest contacts (terrain/dem/refinement/hard_contacts.hpp) --------------------------------------------

struct HardResult {
  i64 count, past;
  u64 overlap, coming;  // bits, m
  u64 deepest[3];       // by kind: bits of the share, then those of the grain, turned over, and of the partner
};

struct HardFinder {
  HardResult* to;
  double above, ahead, radius, deepest_share;

  FURROW_HD void add(double overlap, double parting, u32 id, u32 partner, int kind) const {
    const double share = 0.5 * overlap / radius;
    atomic_add(&to->count, 1);
    if (share > deepest_share) atomic_add(&to->past, 1);
    atomic_max(&to->overlap, bits_of(overlap));
    atomic_max(&to->coming, bits_of(overlap + ahead * (parting < 0.0 ? -parting : 0.0)));
    const u32 turned = ~(id << 4 | partner);
    atomic_max(&to->deepest[kind], static_cast<u64>(bits_of(static_cast<float>(share))) << 32 | turned);
  }
};

struct HardPairsKernel {
  Pointers g;
  HardFinder find;
  Images images;

  FURROW_HD void operator()(int i) const {
    const Low own = g.low[i];
    const u32 count = g.listed[i];
    for (u32 k = 0; k < count; ++k) {
      const u32 entry = g.list[k * g.stride + i], j = entry & kPlaceMask;
      const Low other = g.low[j];
      if (other.id < own.id) continue;
      const Between at = between(own, other, entry >> kSlotBits, images);
      const Triple<double> d{g.unit * at.x, g.unit * at.y, g.unit * at.z};
      const double far = 2.0 * find.radius - find.above, square = dot(d, d);
      if (square >= far * far) continue;
      const double distance = simd::root(square);
      const Triple<double> n = distance > 0.0 ? (1.0 / distance) * d : Triple<double>{0.0, 0.0, 1.0};
      find.add(2.0 * find.radius - distance, dot(triple(g.motion[i].v) - triple(g.motion[j].v), n), own.id, 0, 0);
    }
  }
};

struct HardWallsKernel {
  Pointers g;
  WallPointers w;
  dem::Bin bin;
  HardFinder find;

  FURROW_HD void operator()(int e) const {
    const u32 i = w.grain[e];
    const Triple<double> x = g.position(static_cast<int>(i));
    for (int wall = 0; wall < dem::kWalls; ++wall) {
      if (!has_wall(bin, wall)) continue;
      const double overlap = find.radius - distance_from(bin, wall, x);
      if (overlap > find.above)
        find.add(overlap, dot(triple(g.motion[i].v), wall_normal(wall)), g.low[i].id, static_cast<u32>(wall), 1);
    }
  }
};

}  // namespace furrow::terrain::gpu
