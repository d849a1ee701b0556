// Cohesion, F_n = F_e − F_c with F_c = π r² c_t while in contact: pull-off, rest, and sliding strength without load.
//
// Forces between moved grains are measured on undamped grains of 2000 t that keep their given velocity: its change in a
// step gives the force.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "protocol/core/constants.hpp"
#include "tests/terrain/surface_meshes.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification::cohesion_test {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;   // m
constexpr double kCohesion = 80e3;  // Pa
constexpr double kStep = 1e-5;      // s
constexpr const char* kLaws[] = {"mindlin", "hertz_tanh"};

EngineGrains cohesive(const char* law) {
  EngineGrains few;
  few.options.law = law;
  few.options.cohesion = kCohesion;
  few.options.step = kStep;
  few.options.friction = 0.5;
  few.options.friction_impulse_limit = false;
  return few;
}

EngineGrains heavy(const char* law) {
  EngineGrains few = cohesive(law);
  few.options.density = 2.5e12;
  few.options.restitution = 1.0;
  few.options.normal_damping = 0.0;
  return few;
}

double cohesion_force() { return M_PI * kRadius * kRadius * kCohesion; }
double rest_overlap(double stiffness, double load) { return std::pow(load / stiffness, 2.0 / 3.0); }

/// Moves a heavy pair apart by one step at the given relative velocity; returns the force on the second grain.
Vec3 force_while_moving(terrain::dem::GrainSolver& s, const Vec3& relative) {
  for (int id : {0, 1}) {
    terrain::dem::set_velocity(s, id, (id == 0 ? -0.5 : 0.5) * relative);
    terrain::dem::set_spin(s, id, Vec3::Zero());
  }
  s.step(kStep);
  return s.params().grain.mass / kStep * (terrain::dem::velocity(s, 1) - 0.5 * relative);
}

terrain::dem::GrainSolver pair(const EngineGrains& few, double overlap) {
  return few.make({{0.3, 0, 0.3}, {0.3 + 2 * kRadius - overlap, 0, 0.3}});
}

TEST(Cohesion, pulling_a_pair_apart_takes_the_cohesion_force) {
  for (const char* law : kLaws) {
    const EngineGrains few = heavy(law);
    const double stiffness = few.pair_stiffness(), start = 1e-5;
    terrain::dem::GrainSolver s = pair(few, start);
    Worst path(std::string(law) + ", pair", "force on the way to pull-off", 1e-5, "K delta^1.5 - F_c");
    double largest = 0.0;
    for (int step = 0; step < 5000; ++step) {
      const double overlap = 2 * kRadius - (terrain::dem::position(s, 1) - terrain::dem::position(s, 0)).norm();
      const double force = force_while_moving(s, {3e-4, 0, 0}).x();
      if (s.accounts().contacts == 0) break;
      path.add(force, stiffness * std::pow(overlap, 1.5) - cohesion_force(), cohesion_force());
      largest = std::max(largest, -force);
    }
    EXPECT_EQ(s.accounts().contacts, 0);
    verify(std::string(law) + ", pair", "largest pull, N", largest, cohesion_force(), 1e-5, "pi r^2 c_t");
  }
}

/// A grain under a ceiling (a mesh) hangs if and only if F_c exceeds its weight.
TEST(Cohesion, grain_hangs_from_a_ceiling_if_cohesion_exceeds_its_weight) {
  for (const char* law : kLaws)
    for (const double share : {0.995, 1.005, 3.0}) {
      EngineGrains few = cohesive(law);
      few.gravity = kStandardGravity;
      const double weight = few.mass() * few.gravity;
      few.options.cohesion = share * weight / (M_PI * kRadius * kRadius);
      const terrain::dem::ContactCoefficients k = few.coefficients().floor;
      const double overlap = rest_overlap(few.floor_stiffness(), std::max(share - 1.0, 0.005) * weight);
      terrain::dem::GrainSolver s = few.make({{0.3, 0.0, 0.3 - kRadius + overlap}});
      attach(s, testing::turned_down(testing::sheet(0.2531, -0.0372, 0.02, 4, 4, [](double, double) { return 0.3; })),
             k);
      for (int step = 0; step < 20000; ++step) s.step(kStep);
      const double depth = terrain::dem::position(s, 0).z() + kRadius - 0.3;
      if (share < 1.0) {
        EXPECT_LT(depth, -0.05) << law;
      } else {
        verify(std::string(law) + ", hanging from a mesh, F_c = " + brief(share) + " m g", "overlap, m", depth,
               rest_overlap(few.floor_stiffness(), (share - 1.0) * weight), 1e-6, "K delta^1.5 = F_c - m g");
      }
    }
}

/// Two grains hold each other by cohesion alone and are moved sideways: Mindlin's spring up to μ F_e = μ F_c.
TEST(Cohesion, pair_without_net_load_slips_at_friction_times_cohesion_force) {
  EngineGrains few = heavy("mindlin");
  few.options.friction = 0.05;  // a short distance to slip, over which the line of centres hardly turns
  const auto k = few.pair<terrain::dem::MindlinLaw>();
  const double limit = few.options.friction * cohesion_force();
  const double delta = rest_overlap(k.stiffness, cohesion_force());
  const double at_slip = limit / (k.shear_stiffness * std::sqrt(delta));  // m
  terrain::dem::GrainSolver s = pair(few, delta);
  const std::string name = "mindlin, pair, no net load";
  Worst sticking(name, "friction before slip, of mu F_c", 1e-3, "Mindlin 1949, 8 G* sqrt(R* delta) x displacement");
  Worst sliding(name, "friction after slip, of mu F_c", 1e-3, "mu F_c");
  const double speed = 0.01;
  for (double moved = 0.0; moved < 2.0 * at_slip; moved += kStep * speed) {
    const double friction = -force_while_moving(s, {0, speed, 0}).y() / limit;
    const double spring = (moved + kStep * speed) / at_slip;  // the law moves its spring first
    if (spring < 0.999) sticking.add(friction, spring, 1.0, brief(spring) + " of the slip displacement");
    if (spring > 1.001) sliding.add(friction, 1.0, 1.0, brief(spring) + " of the slip displacement");
  }
}

/// Law hertz_tanh slides at any load: F_t = μ F_c tanh(c v).
TEST(Cohesion, hertz_tanh_pair_without_net_load_resists_by_speed) {
  const EngineGrains few = heavy("hertz_tanh");
  const double limit = few.options.friction * cohesion_force();
  Worst worst("hertz_tanh, pair, no net load", "friction by speed, of mu F_c", 1e-4, "mu F_c tanh(c v)");
  for (const double speed : {0.001, 0.01, 0.1, 1.0}) {
    terrain::dem::GrainSolver s = pair(few, rest_overlap(few.pair_stiffness(), cohesion_force()));
    const double friction = -force_while_moving(s, {0, speed, 0}).y();
    worst.add(friction / limit, std::tanh(few.options.friction_velocity_scale * speed), 0.0, brief(speed) + " m/s");
  }
}

}  // namespace
}  // namespace furrow::verification::cohesion_test
