// The ring in motion in its plane: conserved quantities, order of the energy residual, waves of a spinning ring against
// closed forms, comparison with the static equilibrium.
#include "tire/ring/ring_carcass.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "protocol/core/archive_fields.hpp"
#include "tests/tire/ring/ring_examples.hpp"
#include "tire/ring/ring_solver.hpp"

namespace furrow::tire::ring_carcass_test {
namespace {

using std::numbers::pi;

RingMotion motion(double damping) {
  return {.rim_radius = 0.21, .mass = 20.0, .spin_inertia = 2.2, .damping = damping};
}

/// Sets displacements and velocities of a ring on a spinning rim at the angle 0.
void set_state(RingCarcass& ring, const RingField& q, const PlanarField& w, double spin) {
  Archive archive;
  ring.place(0.0, spin, {});
  ring.save(archive);
  archive.put("ring/u", q.u), archive.put("ring/v", q.v);
  archive.put("ring/velocity_x", w.x), archive.put("ring/velocity_z", w.z);
  ring.restore(archive);
}

TEST(RingCarcass, belt_and_rest_have_mass_and_spin_inertia_of_the_file) {
  const RingMotion m = motion(0.0);
  const RingParams p = truck_ring(48);
  const double belt = belt_mass(m, p.radius), rest = m.mass - belt;
  EXPECT_GT(belt, 0.0);
  EXPECT_GT(rest, 0.0);
  EXPECT_NEAR(belt * p.radius * p.radius + rest * m.rim_radius * m.rim_radius, m.spin_inertia, 1e-12);
  RingCarcass ring(p, m);
  ring.place(0.3, 5.0, {2.0, -1.0});
  EXPECT_NEAR(ring.momentum().x, 2.0 * m.mass, 1e-11);
  EXPECT_NEAR(ring.momentum().z, -m.mass, 1e-11);
  EXPECT_NEAR(ring.angular_momentum(), 5.0 * m.spin_inertia, 1e-11);
  EXPECT_NEAR(ring.kinetic_energy(), 0.5 * m.mass * 5.0 + 0.5 * m.spin_inertia * 25.0, 1e-10);
}

TEST(RingCarcass, a_free_ring_that_spins_settles_in_its_growth_and_needs_nothing_more) {
  RingParams p = truck_ring(48);
  RingCarcass ring(p, motion(5e-3));
  const double spin = 40.0, h = 1e-4;
  ring.place(0.0, spin, {});
  PlanarField none(48);
  for (int k = 1; k <= 4000; ++k) {
    PlaneSums sums;
    ASSERT_TRUE(ring.step(h, {{}, spin * k * h}, none, {}, sums).ok);
    if (k < 4000) continue;
    EXPECT_LT(std::hypot(sums.impulse_x, sums.impulse_z), 1e-6 * h);
    EXPECT_LT(std::abs(sums.turn_impulse), 1e-6 * h);
    EXPECT_LT(std::abs(sums.dissipation), 1e-12);
    // The rule's lag: its steps take their losses from the rim's turn, and the tire's account leaves out both.
    EXPECT_NEAR(sums.rim_work, sums.numerical_loss, 1e-6 * sums.numerical_loss);
  }
  // Sidewall and air carry m Ω² (R + u), at a uniform u.
  RingMechanics mechanics(p);
  RingField q = mechanics.zero(), force = q;
  const double u = ring.displacement().u[0], segment = ring.tread_mass() / 48.0;
  for (double& one : q.u) one = u;
  mechanics.gradient(q, force);
  EXPECT_GT(u, 5e-4);
  EXPECT_NEAR(force.u[7], segment * spin * spin * (p.radius + u), 2e-5 * force.u[7]);
  for (const double one : ring.displacement().u) EXPECT_NEAR(one, u, 1e-10);
}

TEST(RingCarcass, in_free_fall_with_its_rim_nothing_acts) {
  RingCarcass ring(truck_ring(32), motion(5e-3));
  ring.place(0.2, 0.0, {1.0, 0.0});
  const PlanarPoint gravity{0.3, -9.81};
  const double h = 1e-4;
  PlanarField none(32);
  for (int k = 1; k <= 50; ++k) {
    PlaneSums sums;
    ASSERT_TRUE(ring.step(h, {{1.0 + k * h * gravity.x, k * h * gravity.z}, 0.2}, none, gravity, sums).ok);
    EXPECT_LT(std::hypot(sums.impulse_x, sums.impulse_z), 1e-6 * h);
    EXPECT_LT(std::abs(sums.turn_impulse), 1e-6 * h);
  }
  EXPECT_LT(largest(ring.displacement()), 1e-12);
}

/// A rim that shakes and turns unevenly while forces come and go on the lower half.
struct Ride {
  double momentum = 0.0, turn = 0.0;  // residuals over the sum of all impulses
  double residual = 0.0, numerical = 0.0, dissipation = 0.0, solver = 0.0, work = 0.0;  // J

  explicit Ride(double h, RingGas gas = RingGas::exact, double tension = 0.0) {
    RingParams p = with_tension(truck_ring(64), tension);
    p.gas = gas;
    RingCarcass ring(p, motion(2e-3));
    const auto angle = [](double t) { return 8.0 * t + 30.0 * t * t; };
    const auto place = [](double t) {
      return PlanarPoint{2.0 * t + 0.01 * std::sin(60.0 * t), 5e-3 * std::cos(80.0 * t)};
    };
    const auto velocity = [&](double t) {
      const PlanarPoint a = place(t - 1e-6), b = place(t + 1e-6);
      return PlanarPoint{(b.x - a.x) / 2e-6, (b.z - a.z) / 2e-6};
    };
    ring.place(0.0, 8.0, velocity(0.0));
    const auto energy = [&] { return ring.kinetic_energy() + ring.elastic_energy() + ring.pressure_energy(); };
    const double start = energy();
    const PlanarPoint gravity{0.0, -9.81};
    PlaneSums sums;
    PlanarField load(64), before(64);
    double ground = 0.0, weight = 0.0, size = 0.0;
    const int steps = static_cast<int>(std::lround(0.1 / h));
    for (int k = 0; k < steps; ++k) {
      const double t = k * h, middle = t + 0.5 * h;
      for (int j = 0; j < 64; ++j) {
        const bool low = ring.position().z[j] < -0.35;
        load.x[j] = low ? 60.0 * std::sin(70.0 * middle + j) : 0.0;
        load.z[j] = low ? 300.0 * (1.0 - std::cos(100.0 * middle)) : 0.0;
      }
      before = ring.position();
      const PlanarPoint p0 = ring.momentum(), s0 = ring.first_moment(), c0 = ring.centre_velocity();
      const double l0 = ring.angular_momentum();
      const PlanarPoint from = place(t), to = place(t + h), way{(to.x - from.x) / h, (to.z - from.z) / h};
      PlaneSums one;
      EXPECT_TRUE(ring.step(h, {way, angle(t + h)}, load, gravity, one).ok);
      const PlanarPoint p1 = ring.momentum(), s1 = ring.first_moment();
      double ix = 20.0 * h * gravity.x - one.impulse_x, iz = 20.0 * h * gravity.z - one.impulse_z;
      // About the centre, which accelerates: weight and inertia act at the middle of the displacement of the belt's
      // mass.
      const double ax = gravity.x - (way.x - c0.x) / h, az = gravity.z - (way.z - c0.z) / h;
      double turning = h * 0.5 * ((s0.z + s1.z) * ax - (s0.x + s1.x) * az) - one.turn_impulse;
      for (int j = 0; j < 64; ++j) {
        ix += h * load.x[j], iz += h * load.z[j], size += h * std::hypot(load.x[j], load.z[j]);
        const double mx = 0.5 * (before.x[j] + ring.position().x[j]), mz = 0.5 * (before.z[j] + ring.position().z[j]);
        turning += h * (mz * load.x[j] - mx * load.z[j]);
        ground += load.x[j] * (ring.position().x[j] - before.x[j] + h * way.x) +
                  load.z[j] * (ring.position().z[j] - before.z[j] + h * way.z);
      }
      momentum = std::max(momentum, std::hypot(p1.x - p0.x - ix, p1.z - p0.z - iz));
      turn = std::max(turn, std::abs(ring.angular_momentum() - l0 - turning));
      weight +=
          20.0 * h * (gravity.x * way.x + gravity.z * way.z) + gravity.x * (s1.x - s0.x) + gravity.z * (s1.z - s0.z);
      sums.rim_work += one.rim_work, sums.dissipation += one.dissipation, sums.numerical_loss += one.numerical_loss;
      sums.solver_loss += one.solver_loss;
    }
    momentum /= size, turn /= size;
    work = std::abs(ground) + std::abs(sums.rim_work);
    dissipation = sums.dissipation, numerical = sums.numerical_loss, solver = sums.solver_loss;
    residual = ground + weight + sums.rim_work - (energy() - start) - dissipation - numerical - solver;
  }
};

TEST(RingCarcass, momentum_and_angular_momentum_change_by_what_acts_to_round_off) {
  for (const double tension : {0.0, 0.5}) {
    const Ride ride(1e-4, RingGas::exact, tension);
    EXPECT_LT(ride.momentum, 1e-13);
    EXPECT_LT(ride.turn, 1e-13);
  }
}

TEST(RingCarcass, the_account_of_energy_is_left_over_in_second_order_and_the_rule_loses_in_first_order) {
  for (const auto& [gas, tension] :
       {std::pair(RingGas::exact, 0.0), {RingGas::linearised, 0.0}, {RingGas::exact, 0.5}}) {
    const Ride coarse(4e-4, gas, tension), fine(2e-4, gas, tension), finest(1e-4, gas, tension);
    EXPECT_GT(fine.dissipation, 0.5);
    EXPECT_LT(std::abs(fine.residual), 1e-6 * fine.work);
    EXPECT_NEAR(coarse.residual / fine.residual, 4.0, 0.6) << coarse.residual << " " << fine.residual;
    EXPECT_NEAR(fine.residual / finest.residual, 4.0, 0.6) << fine.residual << " " << finest.residual;
    EXPECT_GT(finest.numerical, 0.0);
    EXPECT_NEAR(fine.numerical / finest.numerical, 2.0, 0.2);
    EXPECT_NEAR(fine.dissipation, finest.dissipation, 0.05 * fine.dissipation);
    EXPECT_LT(std::abs(fine.solver), 1e-7 * fine.work);
  }
}

/// Frequencies, rad/s, of waves e^{i(nθ − ωt)} on a ring that spins with Ω, seen from the rim, of the continuous ring:
///   (k₁₁ − m (ω² + Ω²)) (k₂₂ − m (ω² + Ω²)) = (n³ (A + B) − 2 ω m Ω)²,
///   k₁₁ = A n⁴ + B n² + k,   k₂₂ = A n² + B n⁴ + k_t,
/// m the mass per radian and k, k_t the sidewall [the inertia terms of Gong 1993, ch. 3].
double wave_gap(const RingParams& p, double mass, int n, double spin, double omega) {
  const double n2 = n * n, inertia = mass * (omega * omega + spin * spin);
  const double a = p.bending * n2 * n2 + p.shear * n2 + p.sidewall_1 - inertia;
  const double b = p.bending * n2 + p.shear * n2 * n2 + p.tangential - inertia;
  const double c = n * n2 * (p.bending + p.shear) - 2.0 * omega * mass * spin;
  return a * b - c * c;
}

/// The root of smallest magnitude on one side of zero.
double wave_frequency(const RingParams& p, double mass, int n, double spin, double direction) {
  const auto f = [&](double omega) { return wave_gap(p, mass, n, spin, direction * omega); };
  double low = 1.0, step = 1.0;
  while (f(low) * f(low + step) > 0.0) low += step;
  for (double high = low + step; high - low > 1e-10;) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) > 0.0 ? low : high) = middle;
  }
  return direction * low;
}

TEST(RingCarcass, waves_on_a_spinning_ring_have_the_frequencies_of_the_closed_form) {
  constexpr int kSegments = 128;
  RingParams p = linear_ring(kSegments);
  p.bending = 400.0, p.shear = 2e4;
  RingCarcass ring(p, motion(0.0));
  const double mass = ring.tread_mass() / (2.0 * pi), h = 4e-5;
  PlanarField none(kSegments);
  for (const double spin : {0.0, 60.0})
    for (const int n : {2, 3})
      for (const double direction : {1.0, -1.0}) {
        const double omega = wave_frequency(p, mass, n, spin, direction);
        // u = cos(nθ − ωt), v = share sin(nθ − ωt), from the second equation, about the steady growth.
        const double n2 = n * n, inertia = mass * (omega * omega + spin * spin);
        const double k22 = p.bending * n2 + p.shear * n2 * n2 + p.tangential;
        const double share = -(n * n2 * (p.bending + p.shear) - 2.0 * omega * mass * spin) / (k22 - inertia);
        const double stiff = p.sidewall_1;
        const double growth = mass * spin * spin * p.radius / (stiff - mass * spin * spin), size = 1e-4;
        RingField q = ring.ring().zero();
        PlanarField w(kSegments);
        for (int j = 0; j < kSegments; ++j) {
          const double angle = j * ring.ring().angle(), phase = n * angle;
          q.u[j] = growth + size * std::cos(phase), q.v[j] = size * share * std::sin(phase);
          // Rates of cos(nθ − ωt) and sin(nθ − ωt), and the rim's turn adds (Ω v, −Ω (R + u)).
          const double a = size * omega * std::sin(phase) + spin * q.v[j];
          const double b = -size * share * omega * std::cos(phase) - spin * (p.radius + q.u[j]);
          const double sine = -std::sin(angle), cosine = std::cos(angle);
          w.x[j] = a * sine - b * cosine, w.z[j] = a * cosine + b * sine;
        }
        set_state(ring, q, w, spin);
        const auto wave = [&] {
          std::complex<double> sum = 0.0;
          for (int j = 0; j < kSegments; ++j)
            sum += ring.displacement().u[j] * std::polar(1.0, -n * j * ring.ring().angle());
          return sum;
        };
        std::complex<double> before = wave();
        double phase = 0.0;
        const int steps = static_cast<int>(std::lround(4.0 * pi / std::abs(omega) / h));  // two periods
        for (int k = 1; k <= steps; ++k) {
          PlaneSums sums;
          ASSERT_TRUE(ring.step(h, {{}, spin * k * h}, none, {}, sums).ok);
          const std::complex<double> now = wave();
          phase += std::arg(now / before), before = now;
        }
        EXPECT_NEAR(phase / (-omega * steps * h), 1.0, 2e-3) << spin << " " << n << " " << omega / (2.0 * pi) << " Hz";
      }
}

TEST(RingCarcass, pressed_slowly_it_comes_to_the_static_equilibrium) {
  const RingParams p = truck_ring(120);
  const double deflection = 0.02, h = 5e-5, lowering = 0.1;
  RingCarcass ring(p, motion(5e-3));
  ring.place(0.0, 0.0, {});
  PlanarField load(120);
  double force = 0.0, depth_of_force = 0.0, fell = 0.0;
  constexpr double kStiffness = 4e6;  // of the ground under a segment, N/m
  for (int k = 0; k < 3600; ++k) {
    const double speed = k * h < lowering ? deflection / lowering : 0.0;
    double sum = 0.0, deep = 0.0;
    for (int j = 0; j < 120; ++j) {
      const double depth = -(p.radius - fell + ring.position().z[j]);
      load.z[j] = depth > 0.0 ? kStiffness * depth : 0.0;
      sum += load.z[j], deep += load.z[j] * depth;
    }
    PlaneSums sums;
    ASSERT_TRUE(ring.step(h, {{0.0, -speed}, 0.0}, load, {}, sums).ok);
    fell += h * speed;
    force = sums.impulse_z / h, depth_of_force = sum > 0.0 ? deep / sum : 0.0;
  }
  // Depth of the segments in the ground, weighted by their forces.
  EXPECT_LT(depth_of_force, 0.03 * deflection);
  RingSolver peer(p, RingGround::plate(p.radius));
  ASSERT_TRUE(peer.solve({0.0, p.radius - deflection + depth_of_force}).converged);
  EXPECT_NEAR(force / peer.spindle_force().z, 1.0, 1e-2);
}

TEST(RingCarcass, a_changing_pressure_is_no_loss_and_moves_the_ring_to_its_new_balance) {
  RingParams p = with_tension(truck_ring(32));
  RingCarcass ring(p, motion(5e-3));
  ring.place(0.0, 0.0, {});
  PlanarField load(32);
  load.z[16] = 900.0;
  PlaneSums sums;
  const auto go = [&](int steps) {
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(ring.step(1e-4, {}, load, {}, sums).ok);
  };
  go(2000);
  const double before = ring.elastic_energy() + ring.pressure_energy(), high = ring.displacement().u[16];
  ring.set_pressure(1.5e5);
  EXPECT_NEAR(ring.elastic_energy() + ring.pressure_energy(), before, 1e-9);
  go(4000);
  p.pressure = 1.5e5;
  RingCarcass other(p, motion(5e-3));
  other.place(0.0, 0.0, {});
  for (int k = 0; k < 6000; ++k) ASSERT_TRUE(other.step(1e-4, {}, load, {}, sums).ok);
  EXPECT_GT(std::abs(other.displacement().u[16]), 1.05 * std::abs(high));
  for (int j = 0; j < 32; ++j) EXPECT_NEAR(ring.displacement().u[j], other.displacement().u[j], 1e-9);
}

TEST(RingCarcass, what_it_is_not_meant_for_is_said) {
  RingCarcass ring(truck_ring(32), motion(5e-3));
  ring.place(0.0, 0.0, {});
  PlanarField load(32);
  load.z[16] = 1e5;
  Outcome outcome;
  for (int k = 0; k < 2000 && outcome.ok; ++k) {
    PlaneSums sums;
    outcome = ring.step(1e-4, {}, load, {}, sums);
    if (outcome.ok) outcome = ring.check();
  }
  EXPECT_TRUE(holds(outcome.message("tire 0"), "a quarter of its radius"));
}

}  // namespace
}  // namespace furrow::tire::ring_carcass_test
