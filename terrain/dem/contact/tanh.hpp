// tanh for contact laws, with the same bits on every machine and in every lane.
#pragma once

#include "protocol/core/triple.hpp"

namespace furrow::terrain::dem {

/// tanh(x) for x ≥ 0, to 2e-16 absolute in double, 1e-7 in float: with t = 2x = k ln 2 + r, |r| ≤ ½ ln 2,
/// e^t − 1 = 2^k (e^r − 1) + (2^k − 1) and tanh x = (e^t − 1)/(e^t + 1); e^r − 1 by its series to r^13 or r^7.
template <class T>
FURROW_HD inline T tanh_of_positive(T x) {
  using simd::constant;
  constexpr bool kSingle = std::is_same_v<simd::RealOf<T>, float>;
  const T t = simd::smaller(x + x, constant<T>(kSingle ? 20.0 : 40.0));
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
  const T two_k = simd::Numbers<T>::power_of_two(shifted);
  const T e = two_k * (p * r) + (two_k - constant<T>(1.0));
  return e / (e + constant<T>(2.0));
}

}  // namespace furrow::terrain::dem
