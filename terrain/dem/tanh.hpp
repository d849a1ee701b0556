// tanh for the registers of the contact law, the same bits on every machine.
#pragma once

#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

namespace detail {
/// 2^k of k held in the low bits of a number that was rounded by adding 1.5 · 2^52 (double) or 1.5 · 2^23 (float).
inline double power_of_two(double shifted) {
  std::int64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = static_cast<std::int64_t>(static_cast<std::uint64_t>(bits + 1023) << 52);
  std::memcpy(&shifted, &bits, sizeof bits);
  return shifted;
}
inline Double4 power_of_two(Double4 shifted) {
  typedef std::uint64_t Bits __attribute__((vector_size(32)));
  return (Double4)(((Bits)shifted + 1023) << 52);
}
inline Float8 power_of_two(Float8 shifted) {
  typedef std::uint32_t Bits __attribute__((vector_size(32)));
  return (Float8)(((Bits)shifted + 127) << 23);
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
    for (const double c : {1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0}) p = p * r + constant<T>(c);
  } else {
    p = constant<T>(1.0 / 6227020800.0);
    for (const double c : {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0,
                           1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0})
      p = p * r + constant<T>(c);
  }
  const T two_k = detail::power_of_two(shifted);
  const T e = two_k * (p * r) + (two_k - constant<T>(1.0));
  return e / (e + constant<T>(2.0));
}

}  // namespace furrow::terrain::dem
