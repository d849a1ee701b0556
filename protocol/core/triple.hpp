// Formulas written once for one number and for several: a number type T is float, double, or one of the registers of
// simd.hpp. This header needs no register, so formulas that include only this header are plain scalar code.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "protocol/core/host_device.hpp"

namespace furrow::simd {

template <class T>
struct Triple {
  T x, y, z;
};
template <class T>
FURROW_HD inline Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
FURROW_HD inline Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
FURROW_HD inline Triple<T> operator*(const T& s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
FURROW_HD inline Triple<T>& operator+=(Triple<T>& a, const Triple<T>& b) {
  return a = a + b;
}
template <class T>
FURROW_HD inline T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
FURROW_HD inline Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Operations that differ between one number and several; simd.hpp has them for its registers.
template <class T>
struct Numbers {
  using Real = T;
  FURROW_HD static T root(T a) { return std::sqrt(a); }
  /// 2^k of k held in the low bits of a number that was rounded by adding 1.5 · 2^52 (double) or 1.5 · 2^23 (float).
  FURROW_HD static T power_of_two(T shifted) {
    using Bits = std::conditional_t<std::is_same_v<T, float>, std::uint32_t, std::uint64_t>;
    constexpr bool kSingle = std::is_same_v<T, float>;
    static_assert(kSingle || std::is_same_v<T, double>);
    Bits bits;
    std::memcpy(&bits, &shifted, sizeof bits);
    bits = static_cast<Bits>(bits + (kSingle ? 127 : 1023)) << (kSingle ? 23 : 52);
    std::memcpy(&shifted, &bits, sizeof bits);
    return shifted;
  }
};
template <class T>
using RealOf = typename Numbers<T>::Real;

/// `a` in every lane.
template <class T>
FURROW_HD inline T constant(double a) {
  return T{} + static_cast<RealOf<T>>(a);
}
template <class T>
FURROW_HD inline T root(T a) {
  return Numbers<T>::root(a);
}
template <class T>
FURROW_HD inline T larger(T a, T b) {
  return a > b ? a : b;
}
template <class T>
FURROW_HD inline T smaller(T a, T b) {
  return a < b ? a : b;
}

}  // namespace furrow::simd
