#include "tire/ring/ring_params.hpp"

#include "protocol/core/assert.hpp"

namespace furrow::tire {

// k₁q + k₂q² + k₃q³ − f is convex in q ≥ 0, and not negative at f / k₁, f = (1 − σ) p R T: from there Newton's method
// decreases to the root without passing it.
double sidewall_draw(const RingParams& s) {
  FURROW_ASSERT(s.radius > 0.0 && s.width > 0.0 && s.sidewall_1 > 0.0, s.radius, s.width, s.sidewall_1);
  FURROW_ASSERT(s.sidewall_2 >= 0.0 && s.sidewall_3 >= 0.0 && s.pressure >= 0.0, s.sidewall_2, s.sidewall_3);
  constexpr int kMostIterations = 200;
  FURROW_ASSERT(s.tension_share >= 0.0 && s.tension_share <= 1.0, s.tension_share);
  const double load = (1.0 - s.tension_share) * s.pressure * s.radius * s.width;  // N per radian
  double q = load / s.sidewall_1;
  for (int n = 0; n < kMostIterations; ++n) {
    const double force = q * (s.sidewall_1 + q * (s.sidewall_2 + q * s.sidewall_3));
    const double slope = s.sidewall_1 + q * (2.0 * s.sidewall_2 + 3.0 * s.sidewall_3 * q);
    const double next = q - (force - load) / slope;
    if (!(next < q)) break;
    q = next;
  }
  return q;
}

double belt_mass(const RingMotion& m, double radius) {
  const double inner = m.rim_radius * m.rim_radius, outer = radius * radius;
  FURROW_ASSERT(m.mass * inner < m.spin_inertia && m.spin_inertia < m.mass * outer, m.mass, m.spin_inertia);
  return (m.spin_inertia - m.mass * inner) / (outer - inner);
}

}  // namespace furrow::tire
