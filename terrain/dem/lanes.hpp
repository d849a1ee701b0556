// Four doubles at once. The contact law is written once for a type T that is `double` or `Lane`; these are the few
// operations it needs beyond + − × ÷ and comparison.
#pragma once

#include <cmath>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace furrow::dem {

typedef double Lane __attribute__((vector_size(32)));
using LaneMask = decltype(Lane{} < Lane{});
inline constexpr int kLanes = 4;

/// One grain's vector quantity, padded to a lane: w is free for the owner.
struct alignas(32) Quad {
  double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
};

inline Lane load(const Quad& q) {
  Lane v;
  std::memcpy(&v, static_cast<const void*>(&q), sizeof v);
  return v;
}
inline void store(Quad& q, Lane v) { std::memcpy(static_cast<void*>(&q), &v, sizeof v); }
inline Lane splat(double a) { return Lane{a, a, a, a}; }

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

template <class T>
inline T constant(double a);
template <>
inline double constant<double>(double a) {
  return a;
}
template <>
inline Lane constant<Lane>(double a) {
  return splat(a);
}

inline double root(double a) { return std::sqrt(a); }
inline Lane root(Lane a) {
#ifdef __AVX__
  return _mm256_sqrt_pd(a);
#endif
  for (int k = 0; k < kLanes; ++k) a[k] = std::sqrt(a[k]);
  return a;
}

inline double select(bool c, double a, double b) { return c ? a : b; }
inline Lane select(LaneMask c, Lane a, Lane b) { return c ? a : b; }

template <class T>
inline T larger(T a, T b) {
  return select(a > b, a, b);
}
template <class T>
inline T smaller(T a, T b) {
  return select(a < b, a, b);
}

inline double sum_of(Lane a) { return (a[0] + a[1]) + (a[2] + a[3]); }

namespace detail {
/// 2^k · bits: adds an integer held in the low bits of a shifted double to the exponent of 1.
inline double power_of_two(double shifted) {
  long long bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;
  std::memcpy(&shifted, &bits, sizeof bits);
  return shifted;
}
inline Lane power_of_two(Lane shifted) {
  LaneMask bits = (LaneMask)shifted;
  bits = (bits + 1023) << 52;
  return (Lane)bits;
}
}  // namespace detail

/// tanh(x) for x ≥ 0 to 2e-16 absolute: with t = 2x = k ln 2 + r, |r| ≤ ½ ln 2, e^t − 1 = 2^k (e^r − 1) + (2^k − 1) and
/// tanh x = (e^t − 1)/(e^t + 1); e^r − 1 by its series to r^13.
template <class T>
inline T tanh_of_positive(T x) {
  const T t = smaller(x + x, constant<T>(40.0));
  const T shift = constant<T>(6755399441055744.0);  // 1.5 · 2^52: adding it rounds to an integer
  const T shifted = t * 1.4426950408889634 + shift;
  const T k = shifted - shift;
  const T r = (t - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10;
  T p = constant<T>(1.0 / 6227020800.0);
  constexpr double kInverseFactorial[] = {
      1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
      1.0 / 720.0,       1.0 / 120.0,      1.0 / 24.0,      1.0 / 6.0,      0.5,           1.0};
  for (const double c : kInverseFactorial) p = p * r + c;
  const T two_k = detail::power_of_two(shifted);
  const T e = two_k * (p * r) + (two_k - 1.0);
  return e / (e + 2.0);
}

/// Rows (x y z w) of four grains → four x, four y, four z.
inline Triple<Lane> transpose(Lane a, Lane b, Lane c, Lane d) {
  const Lane ab_xz = __builtin_shufflevector(a, b, 0, 4, 2, 6),
             ab_yw = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lane cd_xz = __builtin_shufflevector(c, d, 0, 4, 2, 6),
             cd_yw = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(ab_xz, cd_xz, 0, 1, 4, 5),
          __builtin_shufflevector(ab_yw, cd_yw, 0, 1, 4, 5),
          __builtin_shufflevector(ab_xz, cd_xz, 2, 3, 6, 7)};
}
/// The fourth components too.
inline Triple<Lane> transpose(Lane a, Lane b, Lane c, Lane d, Lane& w) {
  const Lane ab_yw = __builtin_shufflevector(a, b, 1, 5, 3, 7),
             cd_yw = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  w = __builtin_shufflevector(ab_yw, cd_yw, 2, 3, 6, 7);
  return transpose(a, b, c, d);
}
/// Back: four x, y, z, w → rows.
inline void transpose_back(const Triple<Lane>& t, Lane w, Lane row[kLanes]) {
  const Lane xy_02 = __builtin_shufflevector(t.x, t.y, 0, 4, 2, 6),
             xy_13 = __builtin_shufflevector(t.x, t.y, 1, 5, 3, 7);
  const Lane zw_02 = __builtin_shufflevector(t.z, w, 0, 4, 2, 6),
             zw_13 = __builtin_shufflevector(t.z, w, 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(xy_02, zw_02, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(xy_13, zw_13, 0, 1, 4, 5);
  row[2] = __builtin_shufflevector(xy_02, zw_02, 2, 3, 6, 7);
  row[3] = __builtin_shufflevector(xy_13, zw_13, 2, 3, 6, 7);
}

}  // namespace furrow::dem
