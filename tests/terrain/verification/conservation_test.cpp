// Contacts must not create momentum, angular momentum (with spin) or, without damping and friction, energy.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification {
namespace {

using terrain::dem::GrainSolver;

constexpr double kSpacing = 0.0124;  // m, of the grid that grains start from

/// `count` grains in a round clump in the middle of a bin, too wide for them to meet its walls. All have random
/// velocity and spin and are drawn towards the middle.
terrain::dem::GrainSolver clump(EngineGrains few, int count, double speed) {
  few.options.length = few.options.width = 1.2;
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  terrain::dem::Uniform even(11);
  const auto uniform = [&] { return even(); };
  std::vector<terrain::dem::Quad> at;
  for (int k = 0; k < count; ++k)
    at.push_back({0.6 + kSpacing * (k % side - 0.5 * side) + 1e-4 * uniform(),
                  kSpacing * (k / side % side - 0.5 * side) + 1e-4 * uniform(),
                  0.6 + kSpacing * (k / side / side - 0.5 * side) + 1e-4 * uniform(), 0.0});
  terrain::dem::GrainSolver s = few.make(at);
  for (int id = 0; id < count; ++id) {
    const Vec3 inward = (Vec3(0.6, 0.0, 0.6) - terrain::dem::position(s, id)) / (kSpacing * side);
    terrain::dem::set_velocity(s, id, speed * (4.0 * inward + Vec3::NullaryExpr(uniform)));
    terrain::dem::set_spin(s, id, 200.0 * Vec3::NullaryExpr(uniform));
  }
  s.reset_accounts();
  return s;
}

struct Totals {
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();  // about the middle
  double speed = 0.0;                                    // Σ m |v|, kg m/s
};

Totals totals(const terrain::dem::GrainSolver& s) {
  Totals t;
  const auto& g = s.params().grain;
  for (int k = 0; k < s.grains().count; ++k) {
    const Vec3 v = terrain::dem::vec(s.grains().velocity[k]), w = terrain::dem::vec(s.grains().spin[k]);
    const Vec3 arm = terrain::dem::vec(s.grains().position[k]) - Vec3(0.6, 0.0, 0.6);
    t.momentum += g.mass * v;
    t.angular += g.mass * arm.cross(v) + g.inertia * w;
    t.speed += g.mass * v.norm();
  }
  return t;
}

TEST(Conservation, crowd_keeps_momentum_and_angular_momentum_with_spin) {
  for (const char* law : {"mindlin", "hertz_tanh"})
    for (const double rolling : {0.0, 0.1})
      for (const int count : {2, 60, 1500}) {  // 1500: pairs within and between the solver's blocks
        EngineGrains few;
        few.options.law = law;
        few.options.rolling_friction = rolling;
        few.options.cohesion = 20e3;
        few.options.step = 1e-5;
        terrain::dem::GrainSolver s = clump(few, count, 0.3);
        const Totals before = totals(s);
        std::vector<Vec3> spin_before;
        for (int id = 0; id < count; ++id) spin_before.push_back(terrain::dem::spin(s, id));
        for (int step = 0; step < 600; ++step) ASSERT_EQ(s.step(1e-5), -1);
        const Totals after = totals(s);
        double exchanged = 0.0;
        for (int id = 0; id < count; ++id)
          exchanged += s.params().grain.inertia * (terrain::dem::spin(s, id) - spin_before[id]).norm();
        const std::string name =
            std::string(law) + (rolling > 0.0 ? ", rolling resistance" : "") + ", " + std::to_string(count) + " grains";
        EXPECT_GT(exchanged, 1e-7 * count);
        EXPECT_EQ(s.accounts().wall_impulse.norm(), 0.0);
        verify(name, "momentum lost, of all", (after.momentum - before.momentum).norm(), 0.0, 1e-13,
               "Newton's third law", before.speed);
        verify(name, "angular momentum lost, of the spins' change", (after.angular - before.angular).norm(), 0.0, 1e-7,
               "one contact point for both arms", exchanged);
      }
}

/// Without friction and damping, an oblique collision keeps the kinetic energy, to the integrator's order.
TEST(Conservation, elastic_collision_keeps_its_energy) {
  Worst worst("mindlin, elastic, frictionless", "kinetic energy after a pair's collision", 1e-5, "energy balance");
  for (const double offset : {0.0, 0.004, 0.008, 0.011}) {  // m, of the lines of flight
    EngineGrains few;
    few.options.restitution = 1.0;
    few.options.friction = 0.0;
    const double gap = std::sqrt(0.012 * 0.012 - offset * offset) + 1e-6;
    terrain::dem::GrainSolver s = few.make({{0.3, 0, 0.3}, {0.3 + gap, offset, 0.3}});
    terrain::dem::set_velocity(s, 0, {1.0, 0.0, 0.0});
    terrain::dem::set_spin(s, 0, {3.0, 2.0, 1.0});
    const auto& g = s.params().grain;
    const double before = 0.5 * g.mass + 0.5 * g.inertia * 14.0;
    EXPECT_TRUE(step_until_parted(s, 2e-7, 200000));
    EXPECT_GT(terrain::dem::velocity(s, 1).norm(), 0.1);
    worst.add(s.accounts().kinetic, before, 0.0, brief(offset) + " m");
  }
}

/// With friction but no damper, a sticking contact returns its shear energy, minus the loss of the unloading spring;
/// energy is never created.
TEST(Conservation, no_collision_creates_energy) {
  Worst worst("mindlin, elastic, friction", "kinetic energy gained in a collision", 1e-5, "second law");
  for (const double friction : {0.1, 0.5, 2.0, 1e3})
    for (const double offset : {0.0, 0.004, 0.008, 0.011})
      for (const double spin : {-150.0, 0.0, 150.0}) {
        EngineGrains few;
        few.options.restitution = 1.0;
        few.options.friction = friction;
        const double gap = std::sqrt(0.012 * 0.012 - offset * offset) + 1e-6;
        terrain::dem::GrainSolver s = few.make({{0.3, 0, 0.3}, {0.3 + gap, offset, 0.3}});
        terrain::dem::set_velocity(s, 0, {1.0, 0.0, 0.0});
        terrain::dem::set_spin(s, 0, {0.0, 0.0, spin});
        const auto& g = s.params().grain;
        const double before = 0.5 * g.mass + 0.5 * g.inertia * spin * spin;
        step_until_parted(s, 1e-6, 200000);
        worst.add(std::max(s.accounts().kinetic / before, 1.0), 1.0, 0.0, "mu = " + brief(friction));
      }
}

}  // namespace
}  // namespace furrow::verification
