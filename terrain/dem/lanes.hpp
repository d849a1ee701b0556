// Several numbers at once. The contact law is written once for a type T that is `double` (walls, tires), eight floats or
// four doubles (pairs of grains); these are the few operations it needs beyond + − × ÷ and comparison. Lanes are as
// wide on every machine; where there are no registers of 32 bytes the compiler splits them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__AVX__) || defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace furrow::dem {

typedef float FloatLanes __attribute__((vector_size(32)));
typedef double Wide __attribute__((vector_size(32)));  // four lanes, or x, y, z and w of one grain
typedef float Narrow __attribute__((vector_size(16)));
typedef std::int32_t IntLanes __attribute__((vector_size(32)));

template <class Real>
using LanesOf = std::conditional_t<std::is_same_v<Real, float>, FloatLanes, Wide>;
template <class Real>
inline constexpr int kLanesOf = static_cast<int>(sizeof(LanesOf<Real>) / sizeof(Real));

/// Pairs that the filter takes at a time.
inline constexpr int kLanes = 8;

/// One grain's vector quantity: w is free for the owner.
struct alignas(32) Quad {
  double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
};

inline Wide load(const Quad& q) {
  Wide v;
  std::memcpy(&v, static_cast<const void*>(&q), sizeof v);
  return v;
}
inline void store(Quad& q, Wide v) { std::memcpy(static_cast<void*>(&q), &v, sizeof v); }
inline void add(Quad& q, Wide v) { store(q, load(q) + v); }

/// Quads are reached by four times their number: a double's address takes that without a shift.
inline constexpr int kQuad = 4;
inline const double* flat(const Quad* quads) { return reinterpret_cast<const double*>(quads); }
inline double* flat(Quad* quads) { return reinterpret_cast<double*>(quads); }

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

template <class T>
struct Triple {
  T x, y, z;
};
template <class T>
inline Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
inline Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
inline Triple<T> operator*(const T& s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
inline T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
inline Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The scalar type of T.
template <class T>
struct RealOf {
  using type = T;
};
template <>
struct RealOf<FloatLanes> {
  using type = float;
};
template <>
struct RealOf<Wide> {
  using type = double;
};

/// `a` in every lane.
template <class T>
inline T constant(double a) {
  return T{} + static_cast<typename RealOf<T>::type>(a);
}

inline double root(double a) { return std::sqrt(a); }
inline FloatLanes root(FloatLanes a) {
#ifdef __AVX__
  return _mm256_sqrt_ps(a);
#else
  for (int k = 0; k < 8; ++k) a[k] = std::sqrt(a[k]);
  return a;
#endif
}
inline Wide root(Wide a) {
#ifdef __AVX__
  return _mm256_sqrt_pd(a);
#else
  for (int k = 0; k < 4; ++k) a[k] = std::sqrt(a[k]);
  return a;
#endif
}

template <class T>
inline T larger(T a, T b) {
  return a > b ? a : b;
}
template <class T>
inline T smaller(T a, T b) {
  return a < b ? a : b;
}

inline Narrow low_half(FloatLanes v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
inline Narrow high_half(FloatLanes v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
inline FloatLanes join(Narrow low, Narrow high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
// GCC 12 makes four moves through memory of the plain conversions.
inline Wide widened(Narrow v) {
#ifdef __AVX__
  return _mm256_cvtps_pd(v);
#else
  return __builtin_convertvector(v, Wide);
#endif
}
inline Narrow narrowed(Wide v) {
#ifdef __AVX__
  return _mm256_cvtpd_ps(v);
#else
  return __builtin_convertvector(v, Narrow);
#endif
}

/// Bit k: lane k is positive.
inline unsigned positive(Wide v) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(v, Wide{}, _CMP_GT_OQ)));
#else
  unsigned mask = 0;
  for (int k = 0; k < 4; ++k) mask |= (v[k] > 0.0 ? 1u : 0u) << k;
  return mask;
#endif
}

/// The lanes added in pairs, in double precision.
inline Wide folded(FloatLanes v) { return widened(low_half(v)) + widened(high_half(v)); }
inline Wide folded(Wide v) { return v; }
inline double sum_of(Wide v) { return (v[0] + v[1]) + (v[2] + v[3]); }
template <class Lanes>
inline double largest_of(Lanes v) {
  double most = v[0];
  for (int k = 1; k < static_cast<int>(sizeof v / sizeof v[0]); ++k) most = v[k] > most ? v[k] : most;
  return most;
}

namespace detail {
/// 2^k of k held in the low bits of a number that was rounded by adding 1.5 · 2^52 (double) or 1.5 · 2^23 (float).
inline double power_of_two(double shifted) {
  std::int64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = static_cast<std::int64_t>(static_cast<std::uint64_t>(bits + 1023) << 52);
  std::memcpy(&shifted, &bits, sizeof bits);
  return shifted;
}
inline Wide power_of_two(Wide shifted) {
  typedef std::uint64_t Bits __attribute__((vector_size(32)));
  return (Wide)(((Bits)shifted + 1023) << 52);
}
inline FloatLanes power_of_two(FloatLanes shifted) {
  typedef std::uint32_t Bits __attribute__((vector_size(32)));
  return (FloatLanes)(((Bits)shifted + 127) << 23);
}
}  // namespace detail

/// tanh(x) for x ≥ 0, to 2e-16 absolute in double, 1e-7 in float: with t = 2x = k ln 2 + r, |r| ≤ ½ ln 2,
/// e^t − 1 = 2^k (e^r − 1) + (2^k − 1) and tanh x = (e^t − 1)/(e^t + 1); e^r − 1 by its series to r^13 or r^7.
template <class T>
inline T tanh_of_positive(T x) {
  constexpr bool kSingle = std::is_same_v<typename RealOf<T>::type, float>;
  const T t = smaller(x + x, constant<T>(kSingle ? 20.0 : 40.0));
  const T shift = constant<T>(kSingle ? 12582912.0 : 6755399441055744.0);  // adding it rounds to an integer
  const T shifted = t * constant<T>(1.4426950408889634) + shift;
  const T k = shifted - shift;
  const T high = constant<T>(kSingle ? 0.693359375 : 0.693147180369123816490);
  const T low = constant<T>(kSingle ? -2.12194440e-4 : 1.90821492927058770002e-10);
  const T r = (t - k * high) - k * low;
  T p;
  if constexpr (kSingle) {
    p = constant<T>(1.0 / 5040.0);
    for (const double c : {1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0})
      p = p * r + constant<T>(c);
  } else {
    p = constant<T>(1.0 / 6227020800.0);
    for (const double c :
         {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
          1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0})
      p = p * r + constant<T>(c);
  }
  const T two_k = detail::power_of_two(shifted);
  const T e = two_k * (p * r) + (two_k - constant<T>(1.0));
  return e / (e + constant<T>(2.0));
}

/// Four rows of four → four columns.
inline void transpose(Wide (&r)[4]) {
  const Wide ab_xz = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
  const Wide ab_yw = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Wide cd_xz = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
  const Wide cd_yw = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(ab_xz, cd_xz, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(ab_yw, cd_yw, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(ab_xz, cd_xz, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(ab_yw, cd_yw, 2, 3, 6, 7);
}

/// The same in both halves of the registers: rows k and k + 4 of eight rows of four share r[k].
inline void transpose_halves(FloatLanes (&r)[4]) {
  const FloatLanes ab_low = __builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const FloatLanes ab_high = __builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const FloatLanes cd_low = __builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const FloatLanes cd_high = __builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
  r[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
  r[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
  r[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
  r[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Eight rows of eight → eight columns.
inline void transpose(FloatLanes (&r)[8]) {
  FloatLanes a[4] = {r[0], r[1], r[2], r[3]}, b[4] = {r[4], r[5], r[6], r[7]};
  transpose_halves(a);
  transpose_halves(b);
  for (int k = 0; k < 4; ++k) {
    r[k] = __builtin_shufflevector(a[k], b[k], 0, 1, 2, 3, 8, 9, 10, 11);
    r[k + 4] = __builtin_shufflevector(a[k], b[k], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace furrow::dem
