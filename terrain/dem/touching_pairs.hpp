// The filter: which listed pairs of a strip touch, packed without gaps for the contact law.
//
// Distances are taken in double precision. What is handed on is d = x_i − x_j and gap = D² − d², from which the overlap
// is δ = gap / (D + |d|): rounded to float it keeps seven digits however small it is, which D − |d| would not.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "terrain/dem/strips.hpp"

namespace furrow::dem {

/// The touching pairs of one strip, one array per quantity, padded with copies of the last to whole lanes.
template <class Real>
struct TouchingPairs {
  int count = 0;
  std::vector<Real> dx, dy, dz, gap;        // m, m, m, m²
  std::vector<std::int32_t> i, j, pair;     // grains counted from the strip's first; index in its list

  void reserve(int pairs) {
    const std::size_t room = pairs + 2 * kLanes;
    if (i.size() >= room) return;
    for (auto* array : {&dx, &dy, &dz, &gap}) array->resize(room);
    for (auto* array : {&i, &j, &pair}) array->resize(room);
  }
  void pad() {
    if (count == 0) return;
    for (auto* array : {&dx, &dy, &dz, &gap})
      std::fill_n(array->begin() + count, kLanes, (*array)[count - 1]);
    for (auto* array : {&i, &j, &pair}) std::fill_n(array->begin() + count, kLanes, (*array)[count - 1]);
  }
};

namespace detail {
#ifdef __AVX2__
/// For each mask of eight lanes: where the k-th set lane stands.
inline constexpr auto kPacking = [] {
  std::array<std::array<std::int32_t, kLanes>, 256> table{};
  for (int mask = 0; mask < 256; ++mask)
    for (int k = 0, n = 0; k < kLanes; ++k)
      if (mask >> k & 1) table[mask][n++] = k;
  return table;
}();
#endif

/// Writes the lanes of `v` whose bit is set to `out`, in order; up to eight places are written.
inline void pack(FloatLanes v, unsigned mask, float* out) {
#ifdef __AVX2__
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPacking[mask].data()));
  _mm256_storeu_ps(out, _mm256_permutevar8x32_ps(v, order));
#else
  for (int k = 0; k < kLanes; ++k) *out = v[k], out += mask >> k & 1;
#endif
}
inline void pack(IntLanes v, unsigned mask, std::int32_t* out) {
#ifdef __AVX2__
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kPacking[mask].data()));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32((__m256i)v, order));
#else
  for (int k = 0; k < kLanes; ++k) *out = v[k], out += mask >> k & 1;
#endif
}
inline void pack(DoubleLanes v, unsigned mask, double* out) {
#ifdef __AVX512F__
  _mm512_storeu_pd(out, _mm512_maskz_compress_pd(static_cast<__mmask8>(mask), v));
#else
  for (int k = 0; k < kLanes; ++k) *out = v[k], out += mask >> k & 1;
#endif
}

/// Bit k: lane k is positive.
inline unsigned positive(DoubleLanes v) {
#ifdef __AVX512F__
  return _mm512_cmp_pd_mask(v, _mm512_setzero_pd(), _CMP_GT_OQ);
#elif defined(__AVX__)
  const Wide zero{};
  const auto bits = [&](Wide a) { return _mm256_movemask_pd(_mm256_cmp_pd(a, zero, _CMP_GT_OQ)); };
  return bits(__builtin_shufflevector(v, v, 0, 1, 2, 3)) | bits(__builtin_shufflevector(v, v, 4, 5, 6, 7)) << 4;
#else
  unsigned mask = 0;
  for (int k = 0; k < kLanes; ++k) mask |= (v[k] > 0.0 ? 1u : 0u) << k;
  return mask;
#endif
}

inline DoubleLanes join(Wide low, Wide high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
template <class Real>
inline LanesOf<Real> narrowed(DoubleLanes v) {
  if constexpr (std::is_same_v<Real, float>) {
    return __builtin_convertvector(v, FloatLanes);
  } else {
    return v;
  }
}
}  // namespace detail

/// Fills `out` with the touching pairs of `strip` and notes which they are; what pairs that parted left in their
/// history is cleared. `x` points to the position of the strip's first grain; those of the next strip follow.
/// width: of a bin with periodic sides, else 0, m.
template <class Real>
void find_touching(Strip& strip, const Quad* x, double diameter, double width, TouchingPairs<Real>& out) {
  out.reserve(strip.pairs);
  const double diameter2 = diameter * diameter;
  const IntLanes steps{0, 1, 2, 3, 4, 5, 6, 7};
  PairHistory<Real>& history = strip.history<Real>();
  const bool keeps = !history.tangential.empty(), keeps_rolling = !history.rolling.empty();
  int count = 0;
  for (int p = 0; p < strip.pairs; p += kLanes) {
    const std::int32_t *i = &strip.i[p], *j = &strip.j[p];
    const auto d = [&](int k) { return load(x[i[k]]) - load(x[j[k]]); };
    Triple<Wide> low = transpose(d(0), d(1), d(2), d(3)), high = transpose(d(4), d(5), d(6), d(7));
    if (width > 0.0)
      for (Triple<Wide>* part : {&low, &high})
        for (int k = 0; k < 4; ++k) part->y[k] -= width * std::round(part->y[k] / width);
    const DoubleLanes gap = detail::join(diameter2 - dot(low, low), diameter2 - dot(high, high));
    unsigned now = detail::positive(gap);
    if (p + kLanes > strip.pairs) now &= (1u << (strip.pairs - p)) - 1u;
    std::uint8_t& before = strip.touching[p / kLanes];
    if (const unsigned ended = before & ~now; ended != 0)
      for (int k = 0; k < kLanes; ++k)
        if (ended >> k & 1) {
          if (keeps) history.tangential[p + k] = {};
          if (keeps_rolling) history.rolling[p + k] = {};
        }
    before = static_cast<std::uint8_t>(now);
    detail::pack(detail::narrowed<Real>(detail::join(low.x, high.x)), now, &out.dx[count]);
    detail::pack(detail::narrowed<Real>(detail::join(low.y, high.y)), now, &out.dy[count]);
    detail::pack(detail::narrowed<Real>(detail::join(low.z, high.z)), now, &out.dz[count]);
    detail::pack(detail::narrowed<Real>(gap), now, &out.gap[count]);
    detail::pack(load_lanes<IntLanes>(i), now, &out.i[count]);
    detail::pack(load_lanes<IntLanes>(j), now, &out.j[count]);
    detail::pack(steps + p, now, &out.pair[count]);
    count += std::popcount(now);
  }
  out.count = count;
  out.pad();
}

}  // namespace furrow::dem
