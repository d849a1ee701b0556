// Several numbers at once: the vector registers of all kernels. Float8 and Double4 have the same width on every
// machine; without registers of 32 bytes the compiler splits them (vector extensions of GCC and Clang). Besides + − × ÷
// and comparison, these are the few operations that kernels need. Triples, and the operations that single numbers have
// too, are in triple.hpp.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__AVX__) || defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

#include "protocol/core/triple.hpp"

namespace furrow::simd {

inline constexpr int kFloatLanes = 8;   // of a Float8
inline constexpr int kDoubleLanes = 4;  // of a Double4

typedef float Float8 __attribute__((vector_size(32)));
typedef float Float4 __attribute__((vector_size(16)));
typedef double Double4 __attribute__((vector_size(32)));
typedef std::int32_t Int32x8 __attribute__((vector_size(32)));
/// Float8 for addresses that are aligned only like their numbers.
typedef float UnalignedFloat8 __attribute__((vector_size(32), aligned(4), may_alias));
typedef double UnalignedDouble4 __attribute__((vector_size(32), aligned(8), may_alias));

inline Float8 load(const float* p) { return *reinterpret_cast<const UnalignedFloat8*>(p); }
inline void store(float* p, Float8 v) { *reinterpret_cast<UnalignedFloat8*>(p) = v; }
inline Double4 load(const double* p) { return *reinterpret_cast<const UnalignedDouble4*>(p); }
inline void store(double* p, Double4 v) { *reinterpret_cast<UnalignedDouble4*>(p) = v; }
inline void add_to(double* p, Double4 v) { store(p, load(p) + v); }
/// `s` in every lane.
inline Double4 spread(double s) { return Double4{s, s, s, s}; }
/// Sum in lane order, so that the bits are the same everywhere.
inline double sum(Double4 v) { return ((v[0] + v[1]) + v[2]) + v[3]; }
/// Sum of the halves first; also the same everywhere.
inline float sum(Float8 v) { return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7])); }

template <class Real>
using LanesOf = std::conditional_t<std::is_same_v<Real, float>, Float8, Double4>;
template <class Real>
inline constexpr int kLanesOf = static_cast<int>(sizeof(LanesOf<Real>) / sizeof(Real));

template <class Lanes, class Real>
inline Lanes load_lanes(const Real* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
template <class Lanes, class Real>
inline void store_lanes(Real* p, Lanes v) {
  std::memcpy(p, &v, sizeof v);
}

inline Triple<Double4> operator*(double s, const Triple<Double4>& a) { return {s * a.x, s * a.y, s * a.z}; }

template <>
struct Numbers<Float8> {
  using Real = float;
  static Float8 root(Float8 a) {
#ifdef __AVX__
    return _mm256_sqrt_ps(a);
#else
    for (int k = 0; k < 8; ++k) a[k] = std::sqrt(a[k]);
    return a;
#endif
  }
  static Float8 power_of_two(Float8 shifted) {
    typedef std::uint32_t Bits __attribute__((vector_size(32)));
    return (Float8)(((Bits)shifted + 127) << 23);
  }
};
template <>
struct Numbers<Double4> {
  using Real = double;
  static Double4 root(Double4 a) {
#ifdef __AVX__
    return _mm256_sqrt_pd(a);
#else
    for (int k = 0; k < 4; ++k) a[k] = std::sqrt(a[k]);
    return a;
#endif
  }
  static Double4 power_of_two(Double4 shifted) {
    typedef std::uint64_t Bits __attribute__((vector_size(32)));
    return (Double4)(((Bits)shifted + 1023) << 52);
  }
};

inline Float4 low_half(Float8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
inline Float4 high_half(Float8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
inline Float8 join(Float4 low, Float4 high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
// GCC 12 compiles the plain conversion to four moves through memory.
inline Double4 widened(Float4 v) {
#ifdef __AVX__
  return _mm256_cvtps_pd(v);
#else
  return __builtin_convertvector(v, Double4);
#endif
}
inline Float4 narrowed(Double4 v) {
#ifdef __AVX__
  return _mm256_cvtpd_ps(v);
#else
  return __builtin_convertvector(v, Float4);
#endif
}

/// Bit k: lane k is positive.
inline unsigned positive(Double4 v) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(v, Double4{}, _CMP_GT_OQ)));
#else
  unsigned mask = 0;
  for (int k = 0; k < 4; ++k) mask |= (v[k] > 0.0 ? 1u : 0u) << k;
  return mask;
#endif
}

/// The two halves added, in double precision.
inline Double4 folded(Float8 v) { return widened(low_half(v)) + widened(high_half(v)); }
inline Double4 folded(Double4 v) { return v; }
inline double sum_of(Double4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }
template <class Lanes>
inline double largest_of(Lanes v) {
  double most = v[0];
  for (int k = 1; k < static_cast<int>(sizeof v / sizeof v[0]); ++k) most = v[k] > most ? v[k] : most;
  return most;
}

/// Four rows of four → four columns.
inline void transpose(Double4 (&r)[4]) {
  const Double4 ab_xz = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
  const Double4 ab_yw = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Double4 cd_xz = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
  const Double4 cd_yw = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(ab_xz, cd_xz, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(ab_yw, cd_yw, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(ab_xz, cd_xz, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(ab_yw, cd_yw, 2, 3, 6, 7);
}

/// Transposes both halves of the registers: rows k and k + 4 of eight rows of four share r[k].
inline void transpose_halves(Float8 (&r)[4]) {
  const Float8 ab_low = __builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 ab_high = __builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 cd_low = __builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 cd_high = __builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
  r[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
  r[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
  r[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
  r[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Eight rows of eight → eight columns.
inline void transpose(Float8 (&r)[8]) {
  Float8 a[4] = {r[0], r[1], r[2], r[3]}, b[4] = {r[4], r[5], r[6], r[7]};
  transpose_halves(a);
  transpose_halves(b);
  for (int k = 0; k < 4; ++k) {
    r[k] = __builtin_shufflevector(a[k], b[k], 0, 1, 2, 3, 8, 9, 10, 11);
    r[k + 4] = __builtin_shufflevector(a[k], b[k], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace furrow::simd
