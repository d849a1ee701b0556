// Law hertz_tanh, F_e = max(0, √δ (k δ − g v_n)), F_t = μ F_e tanh(c v_s), against its own closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/core/constants.hpp"
#include "tests/terrain/surface_meshes.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;  // m

EngineGrains hertz_tanh() {
  EngineGrains few;
  few.options.law = "hertz_tanh";
  few.options.friction_impulse_limit = false;
  return few;
}

/// Head-on collision of two grains; ratio of relative speeds after and before.
double solver_restitution(const EngineGrains& few, double speed, int steps) {
  terrain::dem::GrainSolver s = few.make({{0.3 - kRadius, 0, 0.3}, {0.3 + kRadius, 0, 0.3}});
  terrain::dem::set_velocity(s, 0, {0.5 * speed, 0, 0});
  terrain::dem::set_velocity(s, 1, {-0.5 * speed, 0, 0});
  const double k = few.options.normal_stiffness, m = 0.5 * few.mass();
  const double dt = 2.94 * std::pow(5.0 * m * speed * speed / (4.0 * k), 0.4) / speed / steps;
  step_until_parted(s, dt, 40 * steps);
  return (terrain::dem::velocity(s, 1) - terrain::dem::velocity(s, 0)).x() / speed;
}

/// The ratio by Runge–Kutta integration of m δ̈ = −max(0, √δ (k δ + g δ̇)), m the reduced mass.
double integrated_restitution(double k, double g, double m, double speed) {
  const double h = 2.94 * std::pow(5.0 * m * speed * speed / (4.0 * k), 0.4) / speed / 50000;
  double x = 1e-9 * h * speed, u = speed;
  const auto acceleration = [&](double at, double v) {
    const double root = std::sqrt(std::max(at, 0.0));
    return -std::max(0.0, root * (k * at + g * v)) / m;
  };
  while (x > 0.0) {
    const double a1 = acceleration(x, u), u2 = u + 0.5 * h * a1, a2 = acceleration(x + 0.5 * h * u, u2);
    const double u3 = u + 0.5 * h * a2, a3 = acceleration(x + 0.5 * h * u2, u3);
    const double u4 = u + h * a3, a4 = acceleration(x + h * u3, u4);
    x += h / 6.0 * (u + 2.0 * u2 + 2.0 * u3 + u4);
    u += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return -u / speed;
}

TEST(HertzTanhLaw, restitution_falls_with_speed_as_the_integrated_equation_says) {
  Worst worst("hertz_tanh, restitution of a pair", "restitution, 1 mm/s to 3 m/s", 1e-3,
              "Runge-Kutta integration of the same equation");
  double before = 1.0;
  for (const double speed : {0.001, 0.01, 0.1, 0.3, 1.0, 3.0}) {
    const EngineGrains few = hertz_tanh();
    const double truth = integrated_restitution(1e6, 60.0, 0.5 * few.mass(), speed);
    worst.add(solver_restitution(few, speed, 10000), truth, 0.0, brief(speed) + " m/s");
    EXPECT_LT(truth, before);
    before = truth;
  }
}

// Weak damping is the viscoelastic sphere of Kuwabara & Kono, F = k δ^{3/2} + 3/2 A k √δ δ̇ with g = 3/2 A k. The loss
// along the elastic path, twice g ∫ √δ δ̇ dδ, gives
//   e = 1 − ζ + 3/5 ζ² + O(ζ³),    ζ = 4/5 B(3/5, 3/2) g δ_m^{3/2} / (m v),  δ_m^{5/2} = 5 m v²/(4 k):  ζ ∝ v^{1/5}.
TEST(HertzTanhLaw, weak_damping_matches_kuwabara_kono_1987_and_ramirez_1999) {
  Worst worst("hertz_tanh, weak damping", "(1 - e)/v^(1/5) by zeta, 1 cm/s to 1 m/s", 1e-3,
              "Kuwabara & Kono 1987 doi:10.1143/JJAP.26.1230, Ramirez et al. 1999 doi:10.1103/PhysRevE.60.4465");
  for (const double speed : {0.01, 0.1, 1.0}) {
    EngineGrains few = hertz_tanh();
    few.options.normal_damping = 3.0;
    const double k = few.options.normal_stiffness, m = 0.5 * few.mass();
    const double depth = std::pow(5.0 * m * speed * speed / (4.0 * k), 0.6);  // δ_m^{3/2}
    const double zeta = 0.8 * std::beta(0.6, 1.5) * few.options.normal_damping * depth / (m * speed);
    const double loss = 1.0 - solver_restitution(few, speed, 20000);
    worst.add(loss / zeta, 1.0 - 0.6 * zeta, 0.0, brief(speed) + " m/s");
  }
}

/// Friction grows with speed until it balances the slope: m g sin α = μ m g cos α tanh(c v).
TEST(HertzTanhLaw, block_creeps_down_an_inclined_mesh_at_the_closed_form_rate) {
  Worst worst("hertz_tanh, block on an inclined mesh", "creep speed, slopes 2 to 35 degrees", 2e-3,
              "v = artanh(tan a/mu)/c");
  for (const double scale : {5.0, 50.0})
    for (const double degrees : {2.0, 10.0, 20.0, 35.0}) {
      EngineGrains few = hertz_tanh();
      few.options.friction_velocity_scale = scale;
      few.gravity = kStandardGravity;
      const double angle = degrees * M_PI / 180.0;
      const terrain::dem::ContactCoefficients k = few.coefficients().floor;
      const double load = few.mass() * few.gravity * std::cos(angle);
      const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));  // +x runs downhill
      const Vec3 foot(0.2, 0.0, 0.3);
      const double rest = kRadius - std::pow(load / few.floor_stiffness(), 2.0 / 3.0);
      terrain::dem::GrainSolver s = few.make({terrain::dem::quad(foot + turn * Vec3(0.0, 0.0, rest))});
      testing::Surface slope = testing::sheet(-0.0931, -0.0172, 0.02, 20, 2, [](double, double) { return 0.0; });
      for (Vec3& x : slope.vertex) x = foot + turn * x;
      attach(s, slope, k);
      const double creep = std::atanh(std::tan(angle) / few.options.friction) / scale;
      // Relaxation time of dv/dt = g sin α − μ g cos α tanh(c v) at its fixed point.
      const double cosh = std::cosh(scale * creep);
      const double time = cosh * cosh / (few.options.friction * few.gravity * std::cos(angle) * scale);
      const double dt = std::min(1e-5, 0.002 * time);
      const int steps = static_cast<int>(9.0 * time / dt);
      for (int step = 0; step < steps; ++step) {
        s.step(dt);
        terrain::dem::set_spin(s, 0, Vec3::Zero());  // a block: only sliding
      }
      worst.add(terrain::dem::velocity(s, 0).dot(turn * Vec3::UnitX()), creep, 0.0,
                brief(degrees) + " degrees, c = " + brief(scale));
    }
}

// A sphere put down sliding: I ω̇ = R F, m v̇ = −F, so v̇_s = −7/2 μ g tanh(c v_s) and
//   sinh(c v_s) = sinh(c u₀) exp(−7/2 μ g c t),     v = (5 u₀ + 2 v_s)/7 → 5 u₀/7.
TEST(HertzTanhLaw, sliding_sphere_follows_its_closed_form_to_five_sevenths) {
  EngineGrains few = hertz_tanh();
  few.options.friction = 0.3;
  few.gravity = kStandardGravity;
  const double speed = 0.4, c = few.options.friction_velocity_scale;
  terrain::dem::GrainSolver s = few.make({{0.1, 0, few.resting_height()}});
  terrain::dem::set_velocity(s, 0, {speed, 0, 0});
  // The arm is r − δ; δ/r is 1.3e-3.
  Worst path("hertz_tanh, sliding sphere", "speed along the way", 1e-3, "sinh(c v_s) = sinh(c u0) exp(-7/2 mu g c t)");
  const double dt = 1e-5;
  for (int step = 1; step <= 60000; ++step) {
    s.step(dt);
    if (step % 1000 != 0) continue;
    const double left = std::sinh(c * speed) * std::exp(-3.5 * 0.3 * few.gravity * c * step * dt);
    path.add(terrain::dem::velocity(s, 0).x(), (5.0 * speed + 2.0 * std::asinh(left) / c) / 7.0, speed,
             brief(step * dt) + " s");
  }
  verify("hertz_tanh, sliding sphere", "final speed, m/s", terrain::dem::velocity(s, 0).x(), 5.0 / 7.0 * speed, 1e-3,
         "5 u0/7");
}

}  // namespace
}  // namespace furrow::verification
