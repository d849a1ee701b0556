// The contact law on the touching pairs of a strip, eight at a time.
//
// With d = x_i − x_j the arms r − δ/2 are ±d/2, so v = v_i − v_j − ½ (ω_i + ω_j) × d, and the torque on i and on j is
// −½ d × F_t. Velocity and spin of a grain are one row of eight numbers: a pair costs two loads and the subtraction of
// rows, and one transposition turns eight pairs into lanes. Forces are added up in double precision, the same number
// to i and with the other sign to j: momentum is conserved to round-off of double whatever the law's precision.
#pragma once

#include <span>
#include <vector>

#include "terrain/dem/contact_law.hpp"
#include "terrain/dem/touching_pairs.hpp"

namespace furrow::dem {

/// Velocity (m/s) and spin (rad/s) of a grain, each padded.
template <class Real>
struct alignas(8 * sizeof(Real)) MotionRow {
  Real v[4], w[4];
};

template <class Real>
inline MotionRow<Real> motion_row(const Quad& v, const Quad& w) {
  const auto lanes = detail::narrowed<Real>(detail::join(load(v), load(w)));
  MotionRow<Real> row;
  std::memcpy(static_cast<void*>(&row), &lanes, sizeof row);
  return row;
}

/// What the law needs besides the pairs.
template <class Real>
struct PairLaw {
  Coefficients<Real> coefficients;
  Real diameter = 0;     // m
  Real step = 0;         // s
  bool measure = false;  // sum |F| too
};

namespace detail {
template <class Real>
inline void add_row(Load& load, const LanesOf<Real>& row) {
  const DoubleLanes v = __builtin_convertvector(row, DoubleLanes);
  add(load.force, __builtin_shufflevector(v, v, 0, 1, 2, 3));
  add(load.torque, __builtin_shufflevector(v, v, 4, 5, 6, 7));
}

template <class Real>
inline LanesOf<Real> rows_of(const HistoryRow<Real>& a, const HistoryRow<Real>& b) {
  typedef Real Row __attribute__((vector_size(4 * sizeof(Real))));
  Row low, high;
  std::memcpy(&low, static_cast<const void*>(&a), sizeof low);
  std::memcpy(&high, static_cast<const void*>(&b), sizeof high);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// x, y, z and w of eight history rows. Rows k and k + 4 share a register, so that a transposition of two 4 × 4 does.
template <class Real>
inline void read_history(const HistoryRow<Real>* h, const std::int32_t* p, Triple<LanesOf<Real>>& v,
                         LanesOf<Real>& w) {
  using L = LanesOf<Real>;
  const L a = rows_of(h[p[0]], h[p[4]]), b = rows_of(h[p[1]], h[p[5]]);
  const L c = rows_of(h[p[2]], h[p[6]]), d = rows_of(h[p[3]], h[p[7]]);
  const L ab_low = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const L ab_high = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const L cd_low = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const L cd_high = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  v.x = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
  v.y = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
  v.z = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
  w = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
}

template <class Real>
inline void write_history(HistoryRow<Real>* h, const std::int32_t* p, const Triple<LanesOf<Real>>& v,
                          const LanesOf<Real>& w) {
  using L = LanesOf<Real>;
  const L xy_low = __builtin_shufflevector(v.x, v.y, 0, 8, 1, 9, 4, 12, 5, 13);
  const L xy_high = __builtin_shufflevector(v.x, v.y, 2, 10, 3, 11, 6, 14, 7, 15);
  const L zw_low = __builtin_shufflevector(v.z, w, 0, 8, 1, 9, 4, 12, 5, 13);
  const L zw_high = __builtin_shufflevector(v.z, w, 2, 10, 3, 11, 6, 14, 7, 15);
  const L rows[4] = {__builtin_shufflevector(xy_low, zw_low, 0, 1, 8, 9, 4, 5, 12, 13),
                     __builtin_shufflevector(xy_low, zw_low, 2, 3, 10, 11, 6, 7, 14, 15),
                     __builtin_shufflevector(xy_high, zw_high, 0, 1, 8, 9, 4, 5, 12, 13),
                     __builtin_shufflevector(xy_high, zw_high, 2, 3, 10, 11, 6, 7, 14, 15)};
  constexpr std::size_t kRow = sizeof(HistoryRow<Real>);
  for (int k = 0; k < 4; ++k) {
    typedef Real Row __attribute__((vector_size(4 * sizeof(Real))));
    const Row low = __builtin_shufflevector(rows[k], rows[k], 0, 1, 2, 3);
    const Row high = __builtin_shufflevector(rows[k], rows[k], 4, 5, 6, 7);
    std::memcpy(static_cast<void*>(&h[p[k]]), &low, kRow);
    std::memcpy(static_cast<void*>(&h[p[k + 4]]), &high, kRow);
  }
}
}  // namespace detail

/// Adds the forces of all pairs to `load` and their sums to `sums`; `motion` and `load` start at the strip's first
/// grain, those of the next strip follow.
template <class Law, bool kRolling, class Real>
void pair_forces(const PairLaw<Real>& law, const TouchingPairs<Real>& pairs, const MotionRow<Real>* motion,
                 PairHistory<Real>& histories, Load* loads, StripSums& sums) {
  using L = LanesOf<Real>;
  const Coefficients<Real> c = law.coefficients;
  const L zero{}, half = constant<L>(0.5), diameter = constant<L>(law.diameter);
  // Signs with which the row of j joins that of i: velocities are subtracted, spins added.
  const L relative{-1, -1, -1, -1, 1, 1, 1, 1}, reaction{-1, -1, -1, -1, 1, 1, 1, 1};
  const auto row = [&](int g) { return load_lanes<L>(motion[g].v); };
  DoubleLanes power{}, elastic{};
  L overlap{};
  double force_sum = 0.0;

  for (int at = 0; at < pairs.count; at += kLanes) {
    const std::int32_t *i = &pairs.i[at], *j = &pairs.j[at], *p = &pairs.pair[at];
    const int valid = std::min(kLanes, pairs.count - at);
    L r[kLanes];
    for (int k = 0; k < kLanes; ++k) r[k] = row(i[k]) + relative * row(j[k]);
    transpose(r);

    const Triple<L> d{load_lanes<L>(&pairs.dx[at]), load_lanes<L>(&pairs.dy[at]),
                      load_lanes<L>(&pairs.dz[at])};
    const L gap = load_lanes<L>(&pairs.gap[at]);
    const L distance = root(dot(d, d));
    ContactMotion<L> m;
    m.overlap = gap / (diameter + distance);
    m.normal = (constant<L>(1.0) / distance) * d;
    const Triple<L> dv{r[0], r[1], r[2]}, turn{r[4], r[5], r[6]};
    m.velocity = dv - half * cross(turn, d);
    m.spin = half * dot(turn, m.normal);
    if constexpr (kRolling) {
      L s[kLanes];
      for (int k = 0; k < kLanes; ++k) s[k] = row(i[k]) - row(j[k]);
      transpose(s);
      m.roll = {s[4], s[5], s[6]};
    }

    ContactHistory<L> history;
    L unused = zero;
    if constexpr (Law::kHistory) {
      detail::read_history(histories.tangential.data(), p, history.tangential, history.root_overlap);
      if constexpr (kRolling) detail::read_history(histories.rolling.data(), p, history.rolling, unused);
    }
    const ContactForce<L> f = Law::template force<kRolling>(c, law.step, m, history);
    if constexpr (Law::kHistory) {
      // Lanes beyond the last pair repeat it, so that writing them again does no harm.
      detail::write_history(histories.tangential.data(), p, history.tangential, history.root_overlap);
      if constexpr (kRolling) detail::write_history(histories.rolling.data(), p, history.rolling, zero);
    }

    const Triple<L> force = f.normal * m.normal + f.tangential;
    const Triple<L> torque = -half * cross(d, f.tangential);
    L out[kLanes] = {force.x, force.y, force.z, zero, torque.x, torque.y, torque.z, zero};
    transpose(out);
    if constexpr (kRolling) {
      L couple[kLanes] = {zero, zero, zero, zero, f.rolling.x, f.rolling.y, f.rolling.z, zero};
      transpose(couple);
      for (int k = 0; k < valid; ++k) {
        detail::add_row<Real>(loads[i[k]], out[k] + couple[k]);
        detail::add_row<Real>(loads[j[k]], reaction * out[k] - couple[k]);
      }
    } else {
      for (int k = 0; k < valid; ++k) {
        detail::add_row<Real>(loads[i[k]], out[k]);
        detail::add_row<Real>(loads[j[k]], reaction * out[k]);
      }
    }

    L work = power_of(f, m);
    if constexpr (kRolling) work += dot(f.rolling, m.roll);
    const IntLanes lane{0, 1, 2, 3, 4, 5, 6, 7};
    const auto real = __builtin_convertvector(lane, L) < constant<L>(valid);
    power += __builtin_convertvector(real ? work : zero, DoubleLanes);
    elastic += __builtin_convertvector(real ? f.energy : zero, DoubleLanes);
    overlap = larger(overlap, m.overlap);
    if (law.measure) force_sum += sum_of(real ? root(dot(force, force)) : zero);
  }
  sums.power += sum_of(power);
  sums.elastic += sum_of(elastic);
  sums.contact_force += force_sum;
  sums.max_overlap = std::max(sums.max_overlap, largest_of(overlap));
  sums.contacts += pairs.count;
}

}  // namespace furrow::dem
