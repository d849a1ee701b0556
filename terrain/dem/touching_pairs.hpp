// The filter: finds the listed pairs of a strip that touch, and packs them without gaps for the contact law.
//
// Distances are computed in double precision. The results are d = x_i − x_j and gap = D² − d², from which the overlap
// is δ = gap / (D + |d|). Rounded to float it keeps seven digits however small it is, which D − |d| would not. D is the
// sum of both radii, the same for all pairs unless grains differ in size.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "protocol/core/assert.hpp"
#include "terrain/dem/strips.hpp"

namespace furrow::terrain::dem {

/// Touching pairs of one strip, one array per quantity, padded to whole lanes with copies of the last pair.
template <class Real>
struct TouchingPairs {
  int count = 0;
  std::vector<Real> dx, dy, dz, gap;  // m, m, m, m²
  std::vector<Real> sum;              // D of grains of several sizes, m
  std::vector<std::uint32_t> i, j;    // kQuad times the grain counted from the strip's first
  std::vector<std::uint32_t> pair;    // twice its index in the list

  void reserve(int pairs) {
    FURROW_ASSERT(pairs >= 0, pairs);
    const std::size_t room = pairs + 2 * kFloatLanes;
    if (i.size() >= room) return;
    for (auto* array : {&dx, &dy, &dz, &gap, &sum}) array->resize(room);
    for (auto* array : {&i, &j, &pair}) array->resize(room);
  }
  void pad() {
    FURROW_ASSERT(i.size() >= static_cast<std::size_t>(count + kFloatLanes), i.size(), count);
    if (count == 0) return;
    for (auto* array : {&dx, &dy, &dz, &gap, &sum})
      std::fill_n(array->begin() + count, kFloatLanes, (*array)[count - 1]);
    for (auto* array : {&i, &j, &pair}) std::fill_n(array->begin() + count, kFloatLanes, (*array)[count - 1]);
  }
};

namespace detail {
#ifdef __AVX2__
/// For each mask of eight lanes: the position of the k-th set lane.
inline constexpr auto kPacking = [] {
  std::array<std::array<std::int32_t, kFloatLanes>, 256> table{};
  for (int mask = 0; mask < 256; ++mask)
    for (int k = 0, n = 0; k < kFloatLanes; ++k)
      if (mask >> k & 1) table[mask][n++] = k;
  return table;
}();
#endif

/// Writes the lanes of `v` whose bit is set to `out`, in order; up to eight places are written.
inline void pack(Float8 v, unsigned mask, float* out) {
#ifdef __AVX2__
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPacking[mask].data()));
  _mm256_storeu_ps(out, _mm256_permutevar8x32_ps(v, order));
#else
  for (int k = 0; k < kFloatLanes; ++k) *out = v[k], out += mask >> k & 1;
#endif
}
inline void pack(Int32x8 v, unsigned mask, std::uint32_t* out) {
#ifdef __AVX2__
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPacking[mask].data()));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32((__m256i)v, order));
#else
  for (int k = 0; k < kFloatLanes; ++k) *out = v[k], out += mask >> k & 1;
#endif
}
inline void pack(Double4 low, Double4 high, unsigned mask, float* out) {
  dem::detail::pack(join(narrowed(low), narrowed(high)), mask, out);
}
inline void pack(Double4 low, Double4 high, unsigned mask, double* out) {
  for (int k = 0; k < 4; ++k) *out = low[k], out += mask >> k & 1;
  for (int k = 0; k < 4; ++k) *out = high[k], out += mask >> (k + 4) & 1;
}

struct TellNobody {
  void operator()(int) const {}
};

}  // namespace detail

/// Fills `out` with those of the pairs [from, to) of `strip` that touch, and marks them in the strip. Clears the
/// histories of pairs that parted, after calling `parts` with the number of each. `x` points to the position of the
/// strip's first grain; the grains of the next strip follow.
/// diameter: of all grains, m, unless kSizes; width: of a bin with periodic sides, else 0, m.
/// @pre the strip's lists are as Strips::size_lists makes them
template <bool kSizes, class Real, class Parts = detail::TellNobody>
void find_touching(Strip& strip, int from, int to, const Quad* x, double diameter, double width,
                   TouchingPairs<Real>& out, const Parts& parts = {}) {
  FURROW_ASSERT(0 <= from && from <= to && to <= strip.pairs, from, to, strip.pairs);
  FURROW_ASSERT(x != nullptr || from == to, from, to);
  FURROW_ASSERT(kSizes || diameter > 0.0, diameter);
  FURROW_ASSERT(width >= 0.0, width);
  FURROW_ASSERT(strip.i.size() == strip.j.size() && strip.i.size() % kFloatLanes == 0, strip.i.size(), strip.j.size());
  FURROW_ASSERT(in_range(strip.pairs, strip.i.size() + 1), strip.pairs, strip.i.size());
  FURROW_ASSERT(strip.touching.size() * kFloatLanes == strip.i.size(), strip.touching.size(), strip.i.size());
  out.reserve(to - from);
  const double diameter2 = diameter * diameter;
  const Double4 partner = {-1.0, -1.0, -1.0, kSizes ? 1.0 : -1.0};  // w: the sum of both radii
  const Int32x8 steps{0, 2, 4, 6, 8, 10, 12, 14};
  PairHistory<Real>& history = strip.history<Real>();
  const double* const at = flat(x);
  const int whole = from / kFloatLanes * kFloatLanes;  // lanes before `from` belong to another part of the strip
  const std::uint32_t *i = strip.i.data() + whole, *j = strip.j.data() + whole;
  std::uint8_t* const touching = strip.touching.data();
  Real *const dx = out.dx.data(), *const dy = out.dy.data(), *const dz = out.dz.data(), *const gap = out.gap.data(),
              *const sum = out.sum.data();
  std::uint32_t *const out_i = out.i.data(), *const out_j = out.j.data(), *const pair = out.pair.data();
  const auto parted = [&](int p, unsigned ended) {
    for (int k = 0; k < kFloatLanes; ++k)
      if (ended >> k & 1) {
        parts(p + k);
        if (!history.tangential.empty()) history.tangential[p + k] = {};
        if (!history.rolling.empty()) history.rolling[p + k] = {};
      }
  };
  int count = 0;
  for (int p = whole; p < to; p += kFloatLanes, i += kFloatLanes, j += kFloatLanes) {
    const auto d = [&](int k) { return load_lanes<Double4>(at + i[k]) + partner * load_lanes<Double4>(at + j[k]); };
    Double4 a[4] = {d(0), d(1), d(2), d(3)}, b[4] = {d(4), d(5), d(6), d(7)};
    transpose(a);
    transpose(b);
    if (width > 0.0)
      for (int k = 0; k < 4; ++k) {
        a[1][k] -= width * std::round(a[1][k] / width);
        b[1][k] -= width * std::round(b[1][k] / width);
      }
    const auto reach2 = [&](const Double4& radii) { return kSizes ? radii * radii : Double4{} + diameter2; };
    const Double4 gap_a = reach2(a[3]) - (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    const Double4 gap_b = reach2(b[3]) - (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    unsigned now = positive(gap_a) | positive(gap_b) << 4;
    unsigned own = (1u << kFloatLanes) - 1u;
    if (p < from) own &= ~0u << (from - p);
    if (p + kFloatLanes > to) own &= (1u << (to - p)) - 1u;
    now &= own;
    const unsigned before = touching[p / kFloatLanes];
    if (const unsigned ended = before & own & ~now; ended != 0) [[unlikely]]
      parted(p, ended);
    touching[p / kFloatLanes] = static_cast<std::uint8_t>((before & ~own) | now);
    detail::pack(a[0], b[0], now, dx + count);
    detail::pack(a[1], b[1], now, dy + count);
    detail::pack(a[2], b[2], now, dz + count);
    detail::pack(gap_a, gap_b, now, gap + count);
    if constexpr (kSizes) detail::pack(a[3], b[3], now, sum + count);
    detail::pack(load_lanes<Int32x8>(i), now, out_i + count);
    detail::pack(load_lanes<Int32x8>(j), now, out_j + count);
    detail::pack(steps + 2 * p, now, pair + count);
    count += std::popcount(now);
  }
  out.count = count;
  out.pad();
}

}  // namespace furrow::terrain::dem
