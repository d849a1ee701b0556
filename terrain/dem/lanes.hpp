// Eight numbers at once. The contact law is written once for a type T that is `double` (walls, tires) or lanes of
// float or double (pairs of grains); these are the few operations it needs beyond + − × ÷ and comparison. Lanes are
// as wide as eight doubles or floats on every machine; the compiler splits them into the registers that exist.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__AVX__) || defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace furrow::dem {

inline constexpr int kLanes = 8;
typedef float FloatLanes __attribute__((vector_size(4 * kLanes)));
typedef double DoubleLanes __attribute__((vector_size(8 * kLanes)));
typedef std::int32_t IntLanes __attribute__((vector_size(4 * kLanes)));

template <class Real>
using LanesOf = std::conditional_t<std::is_same_v<Real, float>, FloatLanes, DoubleLanes>;

/// x, y, z and w of one grain.
typedef double Wide __attribute__((vector_size(32)));

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
struct RealOf<DoubleLanes> {
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
  for (int k = 0; k < kLanes; ++k) a[k] = std::sqrt(a[k]);
  return a;
#endif
}
inline DoubleLanes root(DoubleLanes a) {
#ifdef __AVX512F__
  return _mm512_sqrt_pd(a);
#elif defined(__AVX__)
  const Wide low = _mm256_sqrt_pd(__builtin_shufflevector(a, a, 0, 1, 2, 3));
  const Wide high = _mm256_sqrt_pd(__builtin_shufflevector(a, a, 4, 5, 6, 7));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  for (int k = 0; k < kLanes; ++k) a[k] = std::sqrt(a[k]);
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

template <class Lanes>
inline double sum_of(Lanes v) {
  double sum = 0.0;
  for (int k = 0; k < kLanes; ++k) sum += v[k];
  return sum;
}
template <class Lanes>
inline double largest_of(Lanes v) {
  double most = v[0];
  for (int k = 1; k < kLanes; ++k) most = v[k] > most ? v[k] : most;
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
inline DoubleLanes power_of_two(DoubleLanes shifted) {
  typedef std::uint64_t Bits __attribute__((vector_size(8 * kLanes)));
  return (DoubleLanes)(((Bits)shifted + 1023) << 52);
}
inline FloatLanes power_of_two(FloatLanes shifted) {
  typedef std::uint32_t Bits __attribute__((vector_size(4 * kLanes)));
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
    for (const double c : {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0,
                           1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0,
                           0.5, 1.0})
      p = p * r + constant<T>(c);
  }
  const T two_k = detail::power_of_two(shifted);
  const T e = two_k * (p * r) + (two_k - constant<T>(1.0));
  return e / (e + constant<T>(2.0));
}

/// Rows (x y z w) of four grains → four x, four y, four z.
inline Triple<Wide> transpose(Wide a, Wide b, Wide c, Wide d) {
  const Wide ab_xz = __builtin_shufflevector(a, b, 0, 4, 2, 6),
             ab_yw = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Wide cd_xz = __builtin_shufflevector(c, d, 0, 4, 2, 6),
             cd_yw = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(ab_xz, cd_xz, 0, 1, 4, 5),
          __builtin_shufflevector(ab_yw, cd_yw, 0, 1, 4, 5),
          __builtin_shufflevector(ab_xz, cd_xz, 2, 3, 6, 7)};
}

/// Eight rows of eight → eight columns of eight, in place.
template <class Lanes>
inline void transpose(Lanes (&r)[kLanes]) {
  Lanes half[2][4];  // components 0|4, 1|5, 2|6, 3|7 of rows 0…3 and 4…7
  for (int h = 0; h < 2; ++h) {
    const Lanes &a = r[4 * h], &b = r[4 * h + 1], &c = r[4 * h + 2], &d = r[4 * h + 3];
    const Lanes ab_low = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const Lanes ab_high = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const Lanes cd_low = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const Lanes cd_high = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    half[h][0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
    half[h][1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
    half[h][2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
    half[h][3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (int k = 0; k < 4; ++k) {
    r[k] = __builtin_shufflevector(half[0][k], half[1][k], 0, 1, 2, 3, 8, 9, 10, 11);
    r[k + 4] = __builtin_shufflevector(half[0][k], half[1][k], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

}  // namespace furrow::dem
