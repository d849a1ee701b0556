// The contact law on the touching pairs of a strip, a register at a time: eight in single precision, four in double.
//
// Velocity and spin of a grain are one row. So a pair costs two loads and one subtraction of rows, and one
// transposition turns the rows of eight pairs into lanes. Forces are added in double precision, with the same magnitude
// and opposite signs to i and j: momentum is conserved to the round-off of double, whatever the law's precision.
#pragma once

#include <vector>

#include "terrain/dem/contact/kinematics.hpp"
#include "terrain/dem/contact/size_scale.hpp"
#include "terrain/dem/touching_pairs.hpp"

namespace furrow::terrain::dem {

/// Velocity (m/s) and spin (rad/s) of consecutive grains: as floats in one row of 32 bytes, or as doubles in two.
template <class Real>
struct MotionRows {
  std::vector<Quad> v, w;  // single: v holds both, w is empty

  void grow(std::size_t n) {
    if (v.size() < n) v.resize(n);
    if (std::is_same_v<Real, double> && w.size() < n) w.resize(n);
  }
  /// Fills rows [k, k + n); with kSizes the w of a velocity is the radius, m.
  template <bool kSizes>
  void set(int k, const Quad* position, const Quad* velocity, const Quad* spin, int n) {
    const double *const x = flat(position), *const from_v = flat(velocity), *const from_w = flat(spin);
    double* const out = flat(v.data() + k);
    const auto velocity_of = [&](int g) {
      Double4 row = load_lanes<Double4>(from_v + g);
      if constexpr (kSizes) row = __builtin_shufflevector(row, load_lanes<Double4>(x + g), 0, 1, 2, 7);
      return row;
    };
    for (int g = 0; g < kQuad * n; g += kQuad) {
      if constexpr (std::is_same_v<Real, float>) {
        store_lanes(out + g, join(narrowed(velocity_of(g)), narrowed(load_lanes<Double4>(from_w + g))));
      } else {
        store_lanes(out + g, velocity_of(g));
      }
    }
    if constexpr (std::is_same_v<Real, double>) std::copy_n(spin, n, w.begin() + k);
  }
};
/// Beginning of the rows of a strip's grains.
struct Motion {
  const double* v = nullptr;
  const double* w = nullptr;
};

/// Inputs of the law besides the pairs.
template <class Law, class Real>
struct PairLaw {
  typename Law::template Coefficients<Real> coefficients;
  Real diameter = 0;    // m; not used for grains of several sizes
  Real per_radius = 0;  // 1 / radius of the coefficients, 1/m
  Real step = 0;        // s
  Wanted wanted;
};

namespace detail {
template <bool kRoll>
inline RelativeMotion<Float8> relative_motion(const Motion& motion, const std::uint32_t* i, const std::uint32_t* j,
                                              Float8) {
  const Float8 sign{-1, -1, -1, -1, 1, 1, 1, 1};
  const auto row = [&](std::uint32_t g) { return load_lanes<Float8>(motion.v + g); };
  RelativeMotion<Float8> m;
  Float8 r[8];
  for (int k = 0; k < 8; ++k) r[k] = sign * row(j[k]) + row(i[k]);
  transpose(r);
  m.dv = {r[0], r[1], r[2]};
  m.delta = r[3];
  m.turn = {r[4], r[5], r[6]};
  if constexpr (kRoll) {
    const auto spin_of = [&](std::uint32_t g) { return load_lanes<Float4>(motion.v + g + 2); };
    const auto spin = [&](int k) { return spin_of(i[k]) - spin_of(j[k]); };
    Float8 q[4];
    for (int k = 0; k < 4; ++k) q[k] = join(spin(k), spin(k + 4));
    transpose_halves(q);
    m.roll = {q[0], q[1], q[2]};
  }
  return m;
}

template <bool kRoll>
inline RelativeMotion<Double4> relative_motion(const Motion& motion, const std::uint32_t* i, const std::uint32_t* j,
                                               Double4) {
  RelativeMotion<Double4> m;
  Double4 v[4], w[4], q[4];
  for (int k = 0; k < 4; ++k) {
    const Double4 w_i = load_lanes<Double4>(motion.w + i[k]), w_j = load_lanes<Double4>(motion.w + j[k]);
    v[k] = load_lanes<Double4>(motion.v + i[k]) - load_lanes<Double4>(motion.v + j[k]);
    w[k] = w_i + w_j;
    q[k] = w_i - w_j;
  }
  transpose(v);
  transpose(w);
  m.dv = {v[0], v[1], v[2]};
  m.delta = v[3];
  m.turn = {w[0], w[1], w[2]};
  if constexpr (kRoll) {
    transpose(q);
    m.roll = {q[0], q[1], q[2]};
  }
  return m;
}

/// Adds (f, t + q) to grain i and (−f, t − q) to grain j; q is the couple.
template <bool kCouple>
inline void add_load(double* force, double* torque, std::uint32_t i, std::uint32_t j, Double4 f, Double4 t, Double4 q) {
  const auto increase = [](double* at, Double4 by) { store_lanes(at, load_lanes<Double4>(at) + by); };
  increase(force + i, f);
  increase(torque + i, kCouple ? t + q : t);
  increase(force + j, -f);
  increase(torque + j, kCouple ? t - q : t);
}

/// Adds the loads of the first `valid` lanes.
template <bool kCouple>
inline void add_loads(const Loads& loads, const std::uint32_t* i, const std::uint32_t* j, int valid,
                      const Triple<Float8>& force, const Triple<Float8>& torque, const Triple<Float8>& couple) {
  Float8 r[8] = {force.x, force.y, force.z, {}, torque.x, torque.y, torque.z, {}};
  transpose(r);
  Float8 c[4] = {couple.x, couple.y, couple.z, {}};
  if constexpr (kCouple) transpose_halves(c);
  const auto lane = [&](int k) {
    const Float4 q = k < 4 ? low_half(c[k & 3]) : high_half(c[k & 3]);
    dem::detail::add_load<kCouple>(flat(loads.force), flat(loads.torque), i[k], j[k], widened(low_half(r[k])),
                                   widened(high_half(r[k])), widened(q));
  };
  if (valid == 8) {
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) lane(k);
  } else {
    for (int k = 0; k < valid; ++k) lane(k);
  }
}

template <bool kCouple>
inline void add_loads(const Loads& loads, const std::uint32_t* i, const std::uint32_t* j, int valid,
                      const Triple<Double4>& force, const Triple<Double4>& torque, const Triple<Double4>& couple) {
  Double4 f[4] = {force.x, force.y, force.z, {}}, t[4] = {torque.x, torque.y, torque.z, {}};
  Double4 q[4] = {couple.x, couple.y, couple.z, {}};
  transpose(f);
  transpose(t);
  transpose(q);
  for (int k = 0; k < valid; ++k)
    dem::detail::add_load<kCouple>(flat(loads.force), flat(loads.torque), i[k], j[k], f[k], t[k], q[k]);
}

/// Reads x, y, z and w of the history of the pairs p[0], p[1], …
inline void read_history(const HistoryRow<float>* h, const std::uint32_t* p, Triple<Float8>& v, Float8& w) {
  const auto row = [&](int k) { return load_lanes<Float4>(reinterpret_cast<const double*>(h) + p[k]); };
  Float8 r[4];
  for (int k = 0; k < 4; ++k) r[k] = join(row(k), row(k + 4));
  transpose_halves(r);
  v = {r[0], r[1], r[2]};
  w = r[3];
}
inline void read_history(const HistoryRow<double>* h, const std::uint32_t* p, Triple<Double4>& v, Double4& w) {
  Double4 r[4];
  for (int k = 0; k < 4; ++k) r[k] = load_lanes<Double4>(&h->x + 2 * p[k]);
  transpose(r);
  v = {r[0], r[1], r[2]};
  w = r[3];
}

inline void write_history(HistoryRow<float>* h, const std::uint32_t* p, const Triple<Float8>& v, Float8 w) {
  Float8 r[4] = {v.x, v.y, v.z, w};
  transpose_halves(r);
  for (int k = 0; k < 4; ++k) {
    store_lanes(reinterpret_cast<double*>(h) + p[k], low_half(r[k]));
    store_lanes(reinterpret_cast<double*>(h) + p[k + 4], high_half(r[k]));
  }
}
inline void write_history(HistoryRow<double>* h, const std::uint32_t* p, const Triple<Double4>& v, Double4 w) {
  Double4 r[4] = {v.x, v.y, v.z, w};
  transpose(r);
  for (int k = 0; k < 4; ++k) store_lanes(&h->x + 2 * p[k], r[k]);
}
}  // namespace detail

/// Data that the stages pass on for a tile of pairs, one array per quantity, all in the first-level cache.
template <class Real>
struct PairTile {
  static constexpr int kPairs = 128;
  struct alignas(64) Column {
    Real at[kPairs];
  };
  Column nx, ny, nz;              // normal
  Column overlap, root_overlap;   // m, √m
  Column vx, vy, vz, spin;        // relative velocity at the contact, m/s; mean spin about the normal, rad/s
  Column rx, ry, rz;              // relative spin, rad/s; only with rolling resistance or sizes
  Column delta;                   // r_i − r_j, m; only with sizes
  Column fx, fy, fz, tx, ty, tz;  // force on i, N; torque on both, N m
  Column qx, qy, qz;              // couple on i, N m; only with rolling resistance or sizes
};

/// The contact law on the touching pairs of a strip, tile by tile, in four stages. This keeps the loops short, so that
/// the processor works on several iterations at once while roots and divisions of one are in progress.
template <class Law, bool kRolling, bool kSizes, class Real>
class PairForces {
  static constexpr bool kCouple = kRolling || kSizes;  // the torques on i and j differ

 public:
  using L = LanesOf<Real>;
  static constexpr int kAtOnce = kLanesOf<Real>;

  /// `motion` and `loads` start at the strip's first grain; the grains of the next strip follow.
  PairForces(const PairLaw<Law, Real>& law, const TouchingPairs<Real>& pairs, const Motion& motion,
             PairHistory<Real>& histories, const Loads& loads)
      : law_(law), pairs_(pairs), motion_(motion), histories_(histories), loads_(loads) {}

  /// Adds the forces of all pairs to the loads and their sums to `sums`.
  void run(ContactTotals& sums) {
    for (int first = 0; first < pairs_.count; first += Tile::kPairs) {
      const int count = std::min(Tile::kPairs, pairs_.count - first);
      geometry(first, count);
      motion(first, count);
      if (law_.wanted.losses) sample(first, count);
      law(first, count);
      scatter(first, count);
    }
    if (law_.wanted.losses) add(sums.sample, sampled_);
    sums.power += sum_of(power_);
    sums.elastic += sum_of(elastic_);
    sums.contact_force += sum_of(force_sum_);
    sums.max_overlap = std::max(sums.max_overlap, largest_of(overlap_));
    sums.contacts += pairs_.count;
  }

 private:
  using Tile = PairTile<Real>;
  using Column = typename Tile::Column;
  static L get(const Column& c, int at) { return load_lanes<L>(c.at + at); }
  static void put(Column& c, int at, L v) { store_lanes(c.at + at, v); }
  static Triple<L> get(const Column& x, const Column& y, const Column& z, int at) {
    return {get(x, at), get(y, at), get(z, at)};
  }
  static void put(Column& x, Column& y, Column& z, int at, const Triple<L>& v) {
    put(x, at, v.x), put(y, at, v.y), put(z, at, v.z);
  }
  Triple<L> difference(int p) const {
    return {load_lanes<L>(&pairs_.dx[p]), load_lanes<L>(&pairs_.dy[p]), load_lanes<L>(&pairs_.dz[p])};
  }

  void geometry(int first, int count) {
    L diameter = constant<L>(law_.diameter);
    for (int at = 0; at < count; at += kAtOnce) {
      if constexpr (kSizes) diameter = load_lanes<L>(&pairs_.sum[first + at]);
      ContactMotion<L> m;
      set_pair_overlap(m, difference(first + at), load_lanes<L>(&pairs_.gap[first + at]), diameter);
      put(t_.nx, t_.ny, t_.nz, at, m.normal);
      put(t_.overlap, at, m.overlap);
      put(t_.root_overlap, at, m.root_overlap);
    }
  }

  void motion(int first, int count) {
    for (int at = 0; at < count; at += kAtOnce) {
      const int p = first + at;
      const auto relative = detail::relative_motion<kCouple>(motion_, &pairs_.i[p], &pairs_.j[p], L{});
      ContactMotion<L> m;
      m.normal = get(t_.nx, t_.ny, t_.nz, at);
      set_pair_velocity<kSizes>(m, difference(p), relative);
      put(t_.vx, t_.vy, t_.vz, at, m.velocity);
      put(t_.spin, at, m.spin);
      if constexpr (kSizes) put(t_.delta, at, relative.delta);
      if constexpr (kCouple) put(t_.rx, t_.ry, t_.rz, at, relative.roll);
    }
  }

  /// Coefficients of the pairs from p on, whose data start at `at` of the tile.
  auto coefficients(int p, int at) const {
    if constexpr (kSizes) {
      const L sum = load_lanes<L>(&pairs_.sum[p]), delta = get(t_.delta, at);
      const Real half = Real(0.5) * law_.per_radius;
      return Law::scaled(law_.coefficients, pair_scale<L>(half * (sum + delta), half * (sum - delta)));
    } else {
      return law_.coefficients;
    }
  }

  static L lane_numbers() {
    L order{};
    for (int k = 0; k < kAtOnce; ++k) order[k] = static_cast<Real>(k);
    return order;
  }

  /// Contact motion of the pairs whose data start at `at` of the tile.
  ContactMotion<L> contact_motion(int at) const {
    ContactMotion<L> m;
    m.normal = get(t_.nx, t_.ny, t_.nz, at);
    m.overlap = get(t_.overlap, at);
    m.root_overlap = get(t_.root_overlap, at);
    m.velocity = get(t_.vx, t_.vy, t_.vz, at);
    m.spin = get(t_.spin, at);
    if constexpr (kCouple) m.roll = get(t_.rx, t_.ry, t_.rz, at);
    return m;
  }
  ContactHistory<L> contact_history(const std::uint32_t* p) const {
    ContactHistory<L> history{};
    if constexpr (Law::kHistory) {
      L unused;
      detail::read_history(histories_.tangential.data(), p, history.tangential, history.root_overlap);
      if constexpr (kRolling) detail::read_history(histories_.rolling.data(), p, history.rolling, unused);
    }
    return history;
  }

  /// Adds the losses of the tile, before the law updates its histories. Not inlined, so that the code of the law, and
  /// with it every bit of the motion, is the same with and without samples.
  [[gnu::noinline]] void sample(int first, int count) {
    const L zero{}, order = lane_numbers();
    ContactSampleOf<L> sum;
    for (int at = 0; at < count; at += kAtOnce) {
      const ContactSampleOf<L> one = Law::template sample<kRolling>(
          coefficients(first + at, at), law_.step, contact_motion(at), contact_history(&pairs_.pair[first + at]));
      const auto real = order < constant<L>(count - at);
      for_both(sum, one, [&](L& to, const L& by) { to += real ? by : zero; });
    }
    for_both(sampled_, sum, [](double& to, const L& by) { to += sum_of(folded(by)); });
  }

  void law(int first, int count) {
    const L zero{}, order = lane_numbers();
    L power{}, elastic{}, force_sum{}, largest{};
    for (int at = 0; at < count; at += kAtOnce) {
      const std::uint32_t* p = &pairs_.pair[first + at];
      const ContactMotion<L> m = contact_motion(at);
      ContactHistory<L> history = contact_history(p);
      const ContactForce<L> f = Law::template force<kRolling>(coefficients(first + at, at), law_.step, m, history);
      if constexpr (Law::kHistory) {
        // Lanes beyond the last pair repeat it, so they write the same values again.
        detail::write_history(histories_.tangential.data(), p, history.tangential, history.root_overlap);
        if constexpr (kRolling) detail::write_history(histories_.rolling.data(), p, history.rolling, zero);
      }
      L delta{};
      if constexpr (kSizes) delta = get(t_.delta, at);
      const PairLoads<L> loads = pair_loads<kSizes>(f, m.normal, difference(first + at), delta);
      put(t_.fx, t_.fy, t_.fz, at, loads.force);
      put(t_.tx, t_.ty, t_.tz, at, loads.torque);
      if constexpr (kCouple) put(t_.qx, t_.qy, t_.qz, at, loads.couple);

      L work = power_of(f, m);
      if constexpr (kRolling) work += dot(f.rolling, m.roll);
      const auto real = order < constant<L>(count - at);
      power += real ? work : zero;
      elastic += real ? f.energy : zero;
      largest = larger(largest, m.overlap);
      if (law_.wanted.forces) force_sum += real ? root(dot(loads.force, loads.force)) : zero;
    }
    power_ += folded(power);
    elastic_ += folded(elastic);
    force_sum_ += folded(force_sum);
    overlap_ = larger(overlap_, largest);
  }

  void scatter(int first, int count) {
    for (int at = 0; at < count; at += kAtOnce) {
      Triple<L> couple{};
      if constexpr (kCouple) couple = get(t_.qx, t_.qy, t_.qz, at);
      detail::add_loads<kCouple>(loads_, &pairs_.i[first + at], &pairs_.j[first + at], std::min(kAtOnce, count - at),
                                 get(t_.fx, t_.fy, t_.fz, at), get(t_.tx, t_.ty, t_.tz, at), couple);
    }
  }

  const PairLaw<Law, Real>& law_;
  const TouchingPairs<Real>& pairs_;
  Motion motion_;
  PairHistory<Real>& histories_;
  Loads loads_;
  Tile t_;
  Double4 power_{}, elastic_{}, force_sum_{};  // W, J, N
  L overlap_{};                                // largest, m
  ContactSample sampled_;
};

}  // namespace furrow::terrain::dem
