#include "tire/ring/ring_params.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

// k₁q + k₂q² + k₃q³ − p T (R₀ + q) is convex in q ≥ 0 and not positive at q = 0: from above its root, Newton's method
// falls to it without passing it.
double ring_growth(const RingParams& s) {
  FURROW_ASSERT(s.radius > 0.0 && s.width > 0.0 && s.sidewall_1 > 0.0, s.radius, s.width, s.sidewall_1);
  FURROW_ASSERT(s.sidewall_2 >= 0.0 && s.sidewall_3 >= 0.0 && s.pressure >= 0.0, s.sidewall_2, s.sidewall_3);
  if (s.pressure == 0.0) return 0.0;
  constexpr int kMostIterations = 200;
  const double tension = s.pressure * s.width;  // N/m
  double q = 0.5 * s.radius;
  const auto excess = [&](double at) {
    return at * (s.sidewall_1 + at * (s.sidewall_2 + at * s.sidewall_3)) - tension * (s.radius + at);
  };
  if (!(excess(q) > 0.0)) return -1.0;
  for (int n = 0; n < kMostIterations; ++n) {
    const double slope = s.sidewall_1 + q * (2.0 * s.sidewall_2 + 3.0 * s.sidewall_3 * q) - tension;
    const double next = q - excess(q) / slope;
    if (!(next < q)) break;
    q = next;
  }
  return q;
}

}  // namespace furrow::tire
