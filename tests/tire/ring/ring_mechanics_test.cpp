// Energy, force and tangent of the flexible ring against closed forms.
#include "tire/ring/ring_mechanics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/tire/ring/ring_examples.hpp"

namespace furrow::tire {
namespace {

using std::numbers::pi;

/// The ring without its belt.
RingParams without_belt(RingParams p) {
  p.bending = p.shear = 0.0;
  return p;
}

RingField product(const RingTangent& k, const RingField& x) {  // K x with air
  const int n = static_cast<int>(x.u.size());
  RingField y{std::vector<double>(n), std::vector<double>(n)};
  double sum = 0.0;
  for (const double u : x.u) sum += u;
  for (int j = 0; j < n; ++j) {
    y.u[j] += k.gas * sum;
    for (int d = 0; d < 3; ++d) {
      const int with = (j + d) % n;
      y.u[j] += k.uu[d][j] * x.u[with] + k.uv[d][j] * x.v[with];
      y.v[j] += k.vu[d][j] * x.u[with] + k.vv[d][j] * x.v[with];
      if (d == 0) continue;
      y.u[with] += k.uu[d][j] * x.u[j] + k.vu[d][j] * x.v[j];
      y.v[with] += k.uv[d][j] * x.u[j] + k.vv[d][j] * x.v[j];
    }
  }
  return y;
}

/// σ = 1: the belt alone carries the pressure and does not grow.
TEST(RingMechanics, the_inflated_ring_is_in_balance_without_round_off_and_its_sidewall_holds_what_the_belt_leaves) {
  for (const RingGas gas : {RingGas::exact, RingGas::linearised})
    for (const double share : {0.0, 0.4, 1.0})
      for (const double pressure : {0.0, 70e3, 300e3, 2e6}) {
        RingParams p = with_tension(truck_ring(48), share);
        p.gas = gas, p.pressure = pressure;
        RingMechanics ring(p);
        RingField force = ring.zero();
        ring.gradient(ring.zero(), force);
        EXPECT_EQ(largest(force), 0.0);
        EXPECT_EQ(ring.energy(ring.zero()), 0.0);
        EXPECT_EQ(ring.pressure(ring.zero()), pressure);
        EXPECT_EQ(ring.radius(), p.radius);
        const double q = ring.draw(), load = (1.0 - share) * pressure * p.radius * p.width;
        EXPECT_NEAR(q * (p.sidewall_1 + q * (p.sidewall_2 + q * p.sidewall_3)), load, 1e-13 * load + 1e-15);
      }
}

TEST(RingMechanics, translation_rotation_and_growth_cost_the_belt_nothing) {
  for (const int n : {16, 120, 481, 1920}) {
    RingMechanics ring(truck_ring(n)), bare(without_belt(truck_ring(n)));
    const double bent = ring.energy(wave(ring, 2, 1e-2, -5e-3)) - bare.energy(wave(ring, 2, 1e-2, -5e-3));
    RingField sideways = ring.zero(), rotation = ring.zero(), growth = ring.zero();
    for (int j = 0; j < n; ++j) {
      sideways.u[j] = 1e-2 * std::sin(j * ring.angle()), sideways.v[j] = 1e-2 * std::cos(j * ring.angle());
      rotation.v[j] = growth.u[j] = 1e-2;
    }
    for (const RingField& q : {wave(ring, 1, 1e-2, -1e-2), sideways, rotation, growth}) {
      EXPECT_NEAR(ring.energy(q), bare.energy(q), 1e-13 * bare.energy(q)) << n;
      EXPECT_LT(ring.energy(q) - bare.energy(q), 1e-10 * bent) << n;
      RingField with = ring.zero(), without = ring.zero();
      ring.gradient(q, with), bare.gradient(q, without);
      EXPECT_LE(largest(along(with, without, -1.0)), 4.0 * ring.rounding(q)) << n;
    }
  }
}

TEST(RingMechanics, the_belts_null_space_has_four_dimensions) {
  for (const int n : {16, 25, 48}) {
    RingMechanics ring(truck_ring(n)), bare(without_belt(truck_ring(n)));
    RingTangent with = ring.no_tangent(), without = with;
    ring.tangent(ring.zero(), with), bare.tangent(ring.zero(), without);
    Eigen::MatrixXd belt = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (int k = 0; k < 2 * n; ++k) {
      RingField unit = ring.zero();
      (k < n ? unit.u[k] : unit.v[k - n]) = 1.0;
      const RingField column = along(product(with, unit), product(without, unit), -1.0);
      for (int j = 0; j < n; ++j) belt(j, k) = column.u[j], belt(n + j, k) = column.v[j];
    }
    EXPECT_LT((belt - belt.transpose()).norm(), 1e-12 * belt.norm());
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(belt).eigenvalues();
    EXPECT_LT(values.head(4).cwiseAbs().maxCoeff(), 1e-13 * values[2 * n - 1]) << n;
    EXPECT_GT(values[4], 1e-7 * values[2 * n - 1]) << n;
  }
}

TEST(RingMechanics, what_is_damped_is_the_tangent_without_air_and_tension) {
  RingMechanics ring(with_tension(truck_ring(61)));
  const RingField q = random_field(ring, 0.002, 4), x = random_field(ring, 0.001, 5);
  RingTangent tangent = ring.no_tangent();
  ring.tangent(q, tangent);
  ring.tension().add_tangent(q, -1.0, tangent);
  tangent.gas = 0.0;
  RingField fast = ring.zero();
  ring.without_air(q, x, fast);
  EXPECT_LT(largest(along(product(tangent, x), fast, -1.0)), 1e-13 * largest(fast));
}

TEST(RingMechanics, another_pressure_is_another_ring) {
  RingParams p = with_tension(truck_ring(40));
  RingMechanics changed(p);
  p.pressure = 1.1e5;
  changed.set_pressure(p.pressure);
  const RingMechanics made(p);
  const RingField q = random_field(changed, 0.02, 6);
  EXPECT_EQ(changed.energy(q), made.energy(q));
  EXPECT_EQ(changed.draw(), made.draw());
  EXPECT_LT(changed.air_energy(q), changed.energy(q));
}

TEST(RingMechanics, force_is_the_derivative_of_the_energy_to_round_off) {
  for (const RingGas gas : {RingGas::exact, RingGas::linearised})
    for (const unsigned seed : {1U, 2U, 3U}) {
      RingParams p = truck_ring(61);
      p.gas = gas;
      RingMechanics ring(p);
      const RingField q = random_field(ring, 0.02, seed), change = random_field(ring, 0.002, seed + 10);
      const double work = gauss_mean([&](double share) {
        RingField force = ring.zero();
        ring.gradient(along(q, change, share), force);
        return dot(force, change);
      });
      const double before = ring.energy(q), after = ring.energy(along(q, change, 1.0));
      EXPECT_NEAR(after - before, work, 1e-14 * (std::abs(before) + std::abs(after)));
    }
}

TEST(RingMechanics, tangent_is_the_derivative_of_the_force_to_round_off) {
  for (const RingGas gas : {RingGas::exact, RingGas::linearised}) {
    RingParams p = truck_ring(61);
    p.gas = gas;
    RingMechanics ring(p);
    const RingField q = random_field(ring, 0.02, 1), change = random_field(ring, 0.002, 2),
                    test = random_field(ring, 1.0, 3);
    RingField before = ring.zero(), after = ring.zero();
    ring.gradient(q, before), ring.gradient(along(q, change, 1.0), after);
    const double expected = gauss_mean([&](double share) {
      RingTangent k = ring.no_tangent();
      ring.tangent(along(q, change, share), k);
      return dot(test, product(k, change));
    });
    EXPECT_NEAR(dot(test, after) - dot(test, before), expected, 1e-13 * largest(after) * ring.segments());
  }
}

TEST(RingMechanics, the_inextensible_ring_has_its_classical_bending_energy) {
  RingParams p = truck_ring();
  p.shear = 0.0;
  RingMechanics ring(p), bare(without_belt(p));
  for (const int order : {2, 3, 5}) {
    const RingField q = wave(ring, order, 1e-3, -1e-3 / order);  // hoop strain u + v' = 0
    const double expected = 0.5 * p.bending * pi * std::pow(order * order - 1.0, 2) * 1e-6;
    EXPECT_NEAR(ring.energy(q) - bare.energy(q), expected, 4e-3 * expected) << order;
  }
}

TEST(RingMechanics, turning_the_belt_on_its_rim_takes_the_torsional_stiffness) {
  RingMechanics ring(truck_ring());
  RingField q = ring.zero(), force = ring.zero();
  for (double& v : q.v) v = 0.01 * ring.radius();
  ring.gradient(q, force);
  double moment = 0.0;
  for (const double f : force.v) moment += ring.radius() * f;
  EXPECT_NEAR(moment, 2.0 * pi * ring.radius() * ring.radius() * 2e5 * 0.01, 1e-8 * moment);
}

TEST(RingMechanics, air_keeps_pressure_times_volume) {
  RingParams p = truck_ring();
  RingMechanics ring(p);
  p.gas = RingGas::linearised;
  RingMechanics linear(p);
  RingField q = ring.zero();
  for (double& u : q.u) u = -0.01;
  const double volume = ring.volume() - 2.0 * pi * ring.radius() * p.width * 0.01;
  EXPECT_NEAR((ring.pressure(q) + p.ambient) * volume, (p.pressure + p.ambient) * ring.volume(), 1e-9);
  EXPECT_GT(ring.pressure(q), linear.pressure(q));
  EXPECT_NEAR(linear.pressure(q) - p.pressure, (p.pressure + p.ambient) * (ring.volume() - volume) / ring.volume(),
              1e-6);
}

}  // namespace
}  // namespace furrow::tire
