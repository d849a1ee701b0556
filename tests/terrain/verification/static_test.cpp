// Grains at rest: columns against their exact overlaps, floor force against weight.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "protocol/core/constants.hpp"
#include "tests/terrain/surface_meshes.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/terrain/verification/impact.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification::static_test {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;  // m
constexpr double kStep = 2e-5;     // s

/// Overlap k of a column counted from below carries the grains above it: K δ^{3/2} = n m g + F_c.
TEST(Static, column_stands_on_its_exact_overlaps) {
  constexpr int kCount = 12;
  for (const char* law : {"mindlin", "hertz_tanh"})
    for (const double cohesion : {0.0, 20e3})
      for (const Ground ground : {Ground::plane, Ground::mesh}) {
        EngineGrains few;
        few.options.law = law;
        few.options.cohesion = cohesion;
        few.options.step = kStep;
        few.gravity = kStandardGravity;
        const terrain::dem::SolverCoefficients k = few.coefficients();
        const double bottom = ground == Ground::mesh ? 0.2 : 0.0;
        const double weight = few.mass() * few.gravity;
        std::vector<double> overlap(kCount);
        for (int n = 0; n < kCount; ++n) {
          const double stiffness = n == 0 ? few.floor_stiffness() : few.pair_stiffness();
          overlap[n] = std::pow(((kCount - n) * weight + M_PI * kRadius * kRadius * cohesion) / stiffness, 2.0 / 3.0);
        }
        std::vector<terrain::dem::Quad> at;
        double z = bottom + kRadius;
        for (int n = 0; n < kCount; ++n) {
          at.push_back({0.3, 0.0, z, 0.0});  // not yet overlapping
          z += 2.0 * kRadius - 1e-7;
        }
        at.front().z -= 1e-7;
        terrain::dem::GrainSolver s = few.make(at);
        if (ground == Ground::mesh)
          attach(s, testing::sheet(0.2531, -0.0372, 0.02, 4, 4, [=](double, double) { return bottom; }), k.floor);
        s.set_drag(30.0);
        for (int step = 0; step < 40000; ++step) {
          s.step(kStep);
          for (int g = 0; g < kCount; ++g) {  // guided: a free column buckles
            s.grains().velocity[g].x = s.grains().velocity[g].y = 0.0;
            s.grains().spin[g] = {};
          }
        }
        const std::string name =
            std::string("column of 12, ") + law + ", " + name_of(ground) + (cohesion > 0.0 ? ", cohesion" : "");
        Worst worst(name, "overlaps, m", 1e-5, "K delta^1.5 = n m g + F_c");
        double below = bottom - kRadius;
        for (int n = 0; n < kCount; ++n) {
          const Vec3 x = terrain::dem::position(s, n);
          worst.add((n == 0 ? kRadius : 2.0 * kRadius) - (x.z() - (n == 0 ? bottom : below)), overlap[n], 0.0,
                    "contact " + std::to_string(n));
          below = x.z();
        }
        const Vec3 before = s.accounts().surface_impulse;
        s.step(kStep);
        const double carried =
            ground == Ground::plane ? s.accounts().floor_force : (s.accounts().surface_impulse - before).z() / kStep;
        verify(name, "force on the ground, N", carried, kCount * weight, 1e-5, "n m g");
      }
}

/// Three grains on the ground, touching, one in the hollow between them. Frictionless ground would let them roll
/// apart; friction holds them. By symmetry each lower grain carries a third of the upper one's weight, and its contact
/// with the ground 4/3 of a weight.
TEST(Static, tetrahedron_shares_its_weight_by_symmetry) {
  EngineGrains few;
  few.options.friction = 0.9;
  few.options.step = kStep;
  few.gravity = kStandardGravity;
  const double a = 2.0 * kRadius, height = a * std::sqrt(2.0 / 3.0);
  const double weight = few.mass() * few.gravity;
  std::vector<terrain::dem::Quad> at;
  for (int n = 0; n < 3; ++n) {
    const double phi = 2.0 * M_PI * n / 3.0 + 0.2;
    at.push_back({0.3 + a / std::sqrt(3.0) * std::cos(phi), a / std::sqrt(3.0) * std::sin(phi), kRadius, 0.0});
  }
  at.push_back({0.3, 0.0, kRadius + height, 0.0});
  terrain::dem::GrainSolver s = few.make(at);
  s.set_drag(30.0);
  for (int step = 0; step < 40000; ++step) s.step(kStep);
  verify("tetrahedron, mindlin", "force on the floor, N", s.accounts().floor_force, 4.0 * weight, 1e-5, "4 m g");
  Worst share("tetrahedron, mindlin", "overlap of a lower grain with the floor, m", 1e-4, "K delta^1.5 = 4/3 m g");
  for (int n = 0; n < 3; ++n)
    share.add(kRadius - terrain::dem::position(s, n).z(),
              std::pow(4.0 / 3.0 * weight / few.floor_stiffness(), 2.0 / 3.0));
  EXPECT_LT(std::hypot(terrain::dem::position(s, 3).x() - 0.3, terrain::dem::position(s, 3).y()), 1e-6);
  EXPECT_LT(s.accounts().kinetic, 1e-14);
}

}  // namespace
}  // namespace furrow::verification::static_test
