// Hoop tension of the belt against lengths and areas in closed form, and as the derivative of its own energy.
#include "tire/ring/ring_tension.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ring/ring_examples.hpp"

namespace furrow::tire {
namespace {

using std::numbers::pi;
constexpr double kRadius = 0.39, kStrength = 3e4;  // R, m; σ p T, N/m

RingTension tension(int segments) {
  RingTension t(segments, kRadius);
  t.set(kStrength);
  return t;
}

RingField zero(int n) { return {std::vector<double>(n), std::vector<double>(n)}; }

/// Displacements that move every segment to a point of the plane, given as a function of its angle from straight down.
template <class Point>
RingField placed(int n, Point point) {
  RingField q = zero(n);
  for (int j = 0; j < n; ++j) {
    const double angle = 2.0 * pi * j / n, s = std::sin(angle), c = std::cos(angle);
    const auto [x, z] = point(angle);
    q.u[j] = x * s - z * c - kRadius, q.v[j] = x * c + z * s;
  }
  return q;
}

TEST(RingTension, rigid_motions_of_any_size_cost_nothing) {
  for (const int n : {16, 120, 481, 1920}) {
    const RingTension t = tension(n);
    const double rounding = 1e-15 * t.stiffest() * kRadius;
    for (const double turn : {0.0, 0.3, 2.0})
      for (const double way : {0.0, 0.1, 0.5}) {
        const RingField q = placed(n, [&](double angle) {
          return std::pair(kRadius * std::sin(angle + turn) + way, -kRadius * std::cos(angle + turn) - 0.4 * way);
        });
        RingField force = zero(n);
        t.add_gradient(q, force);
        EXPECT_LT(largest(force), 20.0 * rounding) << n << ' ' << turn << ' ' << way;
        EXPECT_NEAR(t.energy(q), 0.0, 20.0 * n * rounding * kRadius) << n << ' ' << turn << ' ' << way;
      }
  }
}

// A polygon of n sides and the circumradius ρ has the length 2nρ sin(π/n) and the area ½nρ² sin(2π/n).
TEST(RingTension, growth_changes_length_and_area_of_a_regular_polygon) {
  for (const int n : {16, 480}) {
    const RingTension t = tension(n);
    for (const double growth : {-0.1, 1e-3, 0.05}) {
      RingField q = zero(n);
      for (double& u : q.u) u = growth;
      const double expected = -0.5 * n * std::sin(2.0 * pi / n) * growth * growth;  // no term of first order
      EXPECT_NEAR(t.energy(q), kStrength * expected, 1e-12 * kStrength * std::abs(expected));
    }
  }
}

// H (L − 2πR) − σpT (A − πR²), with the length of an ellipse by the complete elliptic integral.
TEST(RingTension, an_ellipse_has_its_length_and_area) {
  const double a = 0.46, b = 0.31;
  const double length = 4.0 * a * std::comp_ellint_2(std::sqrt(1.0 - b * b / (a * a))), area = pi * a * b;
  const double expected = kRadius * (length - 2.0 * pi * kRadius) - (area - pi * kRadius * kRadius);
  double before = 1.0;
  for (const int n : {60, 120, 240, 480}) {
    const RingField q = placed(n, [&](double angle) { return std::pair(a * std::sin(angle), -b * std::cos(angle)); });
    const double error = std::abs(tension(n).energy(q) / kStrength / expected - 1.0);
    EXPECT_LT(error, 0.26 * before) << n;
    before = error;
  }
  EXPECT_LT(before, 2e-3);
}

TEST(RingTension, small_waves_have_the_stiffness_n_squared_less_one) {
  for (const int order : {0, 1, 2, 3, 7}) {
    double before = INFINITY;
    for (const int n : {120, 240, 480}) {
      RingField radial = zero(n), tangential = zero(n);
      for (int j = 0; j < n; ++j) {
        radial.u[j] = 1e-4 * std::cos(order * 2.0 * pi * j / n);
        tangential.v[j] = 1e-4 * std::sin(order * 2.0 * pi * j / n);
      }
      RingTangent k;
      for (auto* blocks : {&k.uu, &k.uv, &k.vu, &k.vv})
        for (auto& one : *blocks) one.resize(n);
      tension(n).add_tangent(zero(n), 1.0, k);
      const double per_radian = tangent_row(k, radial, 0.0, 0)[0] / (2.0 * pi / n) / 1e-4 / kStrength;
      const double error = std::abs(per_radian - (order * order - 1.0));
      EXPECT_LT(error, std::max(0.26 * before, 1e-9)) << order << ' ' << n;
      before = error;
      // The pressure follows the belt: a tangential displacement has no energy in the limit.
      const double along = tangent_row(k, tangential, 0.0, n / 3)[1] / (2.0 * pi / n) / 1e-4 / kStrength;
      EXPECT_LT(std::abs(along), std::pow(order + 1, 4) * 10.0 / n / n);
    }
  }
}

TEST(RingTension, force_and_tangent_are_derivatives_to_round_off) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const int n = 61;
    const RingTension t = tension(n);
    RingParams p = truck_ring(n);
    const RingMechanics ring(p);
    // About a strongly bent ring.
    RingField q = placed(n, [](double angle) { return std::pair(0.46 * std::sin(angle), -0.31 * std::cos(angle)); });
    q = along(q, random_field(ring, 2e-3, seed), 1.0);
    const RingField change = random_field(ring, 1e-4, seed + 10), test = random_field(ring, 1.0, seed + 20);
    const double work = gauss_mean([&](double share) {
      RingField force = ring.zero();
      t.add_gradient(along(q, change, share), force);
      return dot(force, change);
    });
    EXPECT_NEAR(t.energy(along(q, change, 1.0)) - t.energy(q), work, 1e-14 * std::abs(t.energy(q)));
    const double expected = gauss_mean([&](double share) {
      RingTangent k = ring.no_tangent();
      t.add_tangent(along(q, change, share), 0.5, k);
      double sum = 0.0;
      for (int j = 0; j < n; ++j) {
        const auto row = tangent_row(k, change, 0.0, j);
        sum += test.u[j] * row[0] + test.v[j] * row[1];
      }
      return 2.0 * sum;
    });
    RingField before = ring.zero(), after = ring.zero();
    t.add_gradient(q, before), t.add_gradient(along(q, change, 1.0), after);
    EXPECT_NEAR(dot(test, after) - dot(test, before), expected, 1e-13 * largest(after) * n);
  }
}

TEST(RingTension, without_a_share_nothing_is_added) {
  const RingTension none(32, kRadius);
  const RingMechanics ring(truck_ring(32));
  const RingField q = random_field(ring, 0.01, 1);
  RingField force = ring.zero();
  none.add_gradient(q, force);
  EXPECT_EQ(none.energy(q), 0.0);
  EXPECT_EQ(largest(force), 0.0);
  EXPECT_EQ(none.stiffest(), 0.0);
}

}  // namespace
}  // namespace furrow::tire
