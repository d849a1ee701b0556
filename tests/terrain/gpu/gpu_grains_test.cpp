// Grains on the emulated GPU: closed forms, conserved quantities, the order of threads, and the engine dem.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/error.hpp"
#include "terrain/gpu/tire_on_gpu.hpp"
#include "tests/terrain/gpu/gpu_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain::gpu {
namespace {

using dem::FewGrains;
using dem::GrainSolver;
using dem::Quad;

/// Grains in a loose lattice, moved at random, each with its own motion.
GrainSolver cloud(const FewGrains& few, int along, int across, int high, double speed, double spin = 0.0) {
  std::vector<Quad> x;
  dem::Uniform any(7);
  const double r = few.options.radius;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < high; ++k)
        x.push_back({0.2 + 2.1 * r * i + 0.04 * r * any(), -0.1 + 2.1 * r * j + 0.04 * r * any(),
                     1.2 * r + 2.1 * r * k + 0.04 * r * any(), 0.0});
  GrainSolver s = few.make(x);
  for (int g = 0; g < s.grains().count; ++g) {
    set_velocity(s, g, speed * Vec3(any(), any(), any()));
    set_spin(s, g, spin * Vec3(any(), any(), any()));
  }
  return s;
}

constexpr double kGrid = 0x1p-37;  // of positions with grains of 6 mm, m

FewGrains mixed(const std::string& law) {
  FewGrains few;
  few.options.law = law;
  few.precision = dem::Precision::mixed;
  few.options.step = 2e-5;
  return few;
}

TEST(GpuGrains, names_itself_an_emulation) {
  EXPECT_EQ(gpu_library_problem(), "");
  EXPECT_EQ(gpu_device().emulated, 1);
}

TEST(GpuGrains, falls_as_semi_implicit_euler_prescribes_to_the_grid) {
  FewGrains few = mixed("mindlin");
  few.gravity = 9.81;
  SteppedGrains s(few.make({{0.3, 0.0, 0.4, 0.0}}));
  const Vec3 from = s.at.position[0];
  constexpr int kSteps = 1000;
  s.run(2e-5, kSteps);
  const double dt = 2e-5, fallen = 9.81 * dt * dt * kSteps * (kSteps + 1) / 2;
  EXPECT_NEAR(from.z() - s.at.position[0].z(), fallen, kSteps * 0.5 * kGrid);
  EXPECT_NEAR(s.at.velocity[0].z(), -9.81 * dt * kSteps, 1e-12);
}

TEST(GpuGrains, creeps_at_speeds_below_what_single_precision_resolves) {
  GrainSolver solver = mixed("mindlin").make({{0.3, 0.0, 0.4, 0.0}});
  set_velocity(solver, 0, {5e-6, 0.0, 0.0});
  SteppedGrains slow(solver);
  const double from = slow.at.position[0].x();
  slow.run(1e-5, 1000);
  EXPECT_NEAR(slow.at.position[0].x() - from, 5e-8, 1000 * 0.5 * kGrid);  // each step is rounded to the grid
}

// Hertz without damping: largest overlap (5 m* v²/4K)^{2/5}, and no loss of speed [Johnson 1985, Eq. 11.22].
TEST(GpuGrains, collides_as_hertz_prescribes) {
  FewGrains few = mixed("mindlin");
  few.options.restitution = 1.0;
  few.options.friction = 0.0;
  const double r = few.options.radius, v = 0.2;
  GrainSolver solver = few.make({{0.3 - 1.0001 * r, 0.0, 0.3, 0.0}, {0.3 + 1.0001 * r, 0.0, 0.3, 0.0}});
  set_velocity(solver, 0, {v, 0.0, 0.0}), set_velocity(solver, 1, {-v, 0.0, 0.0});
  SteppedGrains s(solver);
  const double m = 0.5 * few.mass(), deepest = std::pow(5.0 * m * 4.0 * v * v / (4.0 * few.pair_stiffness()), 0.4);
  double found = 0.0;
  for (int k = 0; k < 7000; ++k) found = std::max(found, s.run(1e-7, 1).last_overlap);
  EXPECT_NEAR(found / deepest, 1.0, 1e-4);
  s.run(1e-7, 7000);
  EXPECT_NEAR(s.at.velocity[0].x(), -v, 1e-4 * v);
  EXPECT_NEAR(s.at.velocity[1].x(), v, 1e-4 * v);
}

TEST(GpuGrains, rests_on_the_floor_with_the_overlap_of_its_weight) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    FewGrains few = mixed(law);
    few.gravity = 9.81;
    SteppedGrains s(few.make({{0.3, 0.0, few.options.radius, 0.0}}));
    s.run(few.options.step, 30000, 20.0);
    EXPECT_NEAR(few.options.radius - s.at.position[0].z(), few.resting_overlap(), 1e-3 * few.resting_overlap()) << law;
    EXPECT_NEAR(s.grains.sums(false, few.options.step).floor_force, 9.81 * few.mass(), 1e-3 * 9.81 * few.mass()) << law;
  }
}

TEST(GpuGrains, keeps_momentum_whatever_the_law) {
  for (const char* law : {"mindlin", "hertz_tanh"})
    for (const double rolling : {0.0, 0.2})
      for (const double cohesion : {0.0, 2e4}) {
        FewGrains few = mixed(law);
        few.options.rolling_friction = rolling, few.options.cohesion = cohesion;
        GrainSolver solver = cloud(few, 4, 4, 4, 0.3, 20.0);
        for (int g = 0; g < solver.grains().count; ++g) solver.grains().position[g].z += 0.2;  // away from the floor
        solver = few.make([&] {
          std::vector<Quad> x(solver.grains().position.begin(), solver.grains().position.begin() + 64);
          return x;
        }());
        dem::Uniform any(5);
        for (int g = 0; g < 64; ++g) set_velocity(solver, g, 0.3 * Vec3(any(), any(), any()));
        SteppedGrains s(solver);
        const double m = few.mass();
        const Vec3 before = s.momentum(m);
        double contacts = 0.0;
        for (int k = 0; k < 20; ++k) {
          s.run(few.options.step, 40);
          contacts += s.grains.sums(false, few.options.step).contacts;
        }
        EXPECT_GT(contacts, 20.0);
        EXPECT_LT((s.momentum(m) - before).norm(), 1e-13 * m * 0.3 * 64 * 800) << law << ' ' << rolling;
      }
}

TEST(GpuGrains, has_the_same_bits_for_every_order_of_threads) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    FewGrains few = mixed(law);
    few.gravity = 9.81;
    few.options.rolling_friction = 0.1;
    const GrainSolver solver = cloud(few, 5, 5, 4, 0.4, 10.0);
    std::vector<std::uint64_t> hashes;
    std::vector<double> elastic, lost;
    for (int order = 0; order < 3; ++order) {
      SteppedGrains s(solver, order);
      s.run(few.options.step, 700);
      hashes.push_back(s.hash());
      const Sums sums = s.grains.sums(true, few.options.step);
      EXPECT_GT(sums.rebuilds, 3);
      elastic.push_back(sums.elastic), lost.push_back(sums.losses[0] + sums.losses[1]);
    }
    for (int order = 1; order < 3; ++order) {
      EXPECT_EQ(hashes[order], hashes[0]) << law;
      EXPECT_EQ(elastic[order], elastic[0]) << law;
      EXPECT_EQ(lost[order], lost[0]) << law;
    }
  }
}

TEST(GpuGrains, does_not_depend_on_when_lists_are_made) {
  FewGrains few = mixed("mindlin");
  few.gravity = 9.81;
  few.options.rolling_friction = 0.1;
  const GrainSolver solver = cloud(few, 5, 5, 4, 0.4, 10.0);
  SteppedGrains whole(solver), pieces(solver);
  whole.run(few.options.step, 600);
  for (int k = 0; k < 6; ++k) {
    pieces.run(few.options.step, 100);
    // A bed that is placed again with all that it remembers goes on with the same bits, from new lists.
    const Histories histories = pieces.grains.histories();
    EXPECT_GT(histories.pairs.size(), 5U);
    pieces.grains.place(pieces.at);
    pieces.grains.remember(histories);
  }
  EXPECT_EQ(whole.hash(), pieces.hash());
}

TEST(GpuGrains, steps_as_the_engine_dem_does_from_the_same_bed) {
  for (const char* law : {"mindlin", "hertz_tanh"})
    for (const double rolling : {0.0, 0.3}) {
      FewGrains few = mixed(law);
      few.gravity = 9.81;
      few.options.rolling_friction = rolling, few.options.cohesion = 2e3;
      GrainSolver solver = cloud(few, 6, 6, 4, 0.05, 5.0);
      dem::run(solver, few.options.step, 2000);  // the grains lie on the floor and on each other
      ASSERT_GT(solver.accounts().contacts, 100);
      SteppedGrains s(solver);
      double first = 0.0;
      for (int k = 1; k <= 300; ++k) {
        ASSERT_EQ(solver.step(few.options.step), -1);
        ASSERT_EQ(s.run(few.options.step, 1).stop, Stop::none);
        double farthest = 0.0;
        for (int id = 0; id < s.grains.count(); ++id)
          farthest = std::max(farthest, (s.at.position[id] - position(solver, id)).norm());
        if (k == 1) first = farthest;
        EXPECT_LT(farthest, k <= 20 ? 1e-9 : 1e-6) << law << ' ' << rolling << ' ' << k;
      }
      EXPECT_LT(first, 3.0 * kGrid) << law << ' ' << rolling;
      dem::Accounts a = solver.accounts();
      const Sums sums = s.grains.sums(false, few.options.step);
      EXPECT_NEAR(sums.contacts, static_cast<double>(a.contacts), 2.0);
      EXPECT_NEAR(sums.floor_force, a.floor_force, 2e-3 * std::abs(a.floor_force));
    }
}

TEST(GpuGrains, takes_the_impulse_of_the_walls_into_the_momentum) {
  FewGrains few = mixed("mindlin");
  few.options.length = few.options.width = 0.1;
  few.gravity = 9.81;
  few.options.friction = 0.5;
  std::vector<Quad> x;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x.push_back({0.02 + 0.03 * i, -0.03 + 0.03 * j, 0.01 + 0.001 * (i + j), 0.0});
  GrainSolver solver = few.make(x);
  dem::Uniform any(3);
  for (int g = 0; g < 9; ++g) set_velocity(solver, g, {any(), any(), any()});
  SteppedGrains s(solver);
  const double m = few.mass(), dt = few.options.step;
  const Vec3 before = s.momentum(m);
  s.run(dt, 4000);
  const Vec3 gravity = 9 * m * 4000 * dt * Vec3(0.0, 0.0, -9.81), walls = s.grains.wall_impulse();
  EXPECT_GT(walls.z(), 0.0);
  EXPECT_LT((s.momentum(m) - before - gravity - walls).norm(), 1e-12);
}

TEST(GpuGrains, crosses_periodic_sides_as_if_there_were_none) {
  FewGrains few = mixed("mindlin");
  few.options.periodic_x = true;
  few.options.sides = "periodic";
  few.options.length = few.options.width = 0.12;
  const auto shifted = [&](const Vec3& by) {
    std::vector<Quad> x;
    dem::Uniform any(11);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          Quad p{0.03 + 0.0121 * i + by.x(), 0.0121 * (j - 1) + by.y(), 0.05 + 0.0121 * k, 0.0};
          p.x = p.x - 0.12 * std::floor(p.x / 0.12), p.y = p.y - 0.12 * std::floor(p.y / 0.12 + 0.5);
          x.push_back(p);
        }
    GrainSolver solver = few.make(x);
    for (int g = 0; g < 27; ++g) set_velocity(solver, g, Vec3(0.2 * any(), 0.2 * any(), 0.2 * any()));
    SteppedGrains s(solver);
    s.run(few.options.step, 1500);
    return s.at.velocity;
  };
  const auto inside = shifted({0.015, 0.0, 0.0}), across = shifted({0.072, 0.055, 0.0});
  double most = 0.0, moved = 0.0;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    most = std::max(most, (inside[k] - across[k]).norm());
    moved = std::max(moved, inside[k].norm());
  }
  EXPECT_LT(most, 1e-4 * moved);
}

TEST(GpuGrains, reports_a_grain_that_leaves_the_bin) {
  FewGrains few = mixed("mindlin");
  few.options.young_modulus = 1e3;
  GrainSolver solver = few.make({{0.3, 0.0, 0.02, 0.0}, {0.4, 0.0, 0.3, 0.0}});
  set_velocity(solver, 0, {0.0, 0.0, -200.0});
  SteppedGrains s(solver);
  const RunResult result = s.run(2e-5, 200);
  EXPECT_EQ(result.stop, Stop::lost);
  EXPECT_EQ(result.lost, 0);
  EXPECT_LT(result.done, 200);
}

TEST(GpuGrains, stops_before_contacts_may_be_too_deep) {
  FewGrains few = mixed("mindlin");
  const double r = few.options.radius;
  GrainSolver solver = few.make({{0.3 - 1.001 * r, 0.0, 0.3, 0.0}, {0.3 + 1.001 * r, 0.0, 0.3, 0.0}});
  set_velocity(solver, 0, {2.0, 0.0, 0.0});
  SteppedGrains s(solver);
  const double most = 0.02 * r;
  const RunResult result = s.grains.run({1000, 2e-6, 2e-6, 0.0, 0.0, most, 0.0});
  EXPECT_EQ(result.stop, Stop::overlap);
  EXPECT_LE(result.max_overlap, most);
  const Hardest hard = s.grains.hardest(0.5 * most, 1e-5);
  EXPECT_EQ(hard.count, 1);
  EXPECT_EQ(hard.kind, 0);
  EXPECT_LE(hard.overlap, most);
  EXPECT_GT(hard.coming, hard.overlap + 1e-5 * 1.5);
  EXPECT_NEAR(hard.share, 0.5 * hard.overlap / r, 1e-6);
}

TEST(GpuGrains, holds_grains_on_a_slope_by_friction_and_rolling_resistance) {
  FewGrains few = mixed("mindlin");
  few.gravity = 9.81, few.slope = 0.1;
  few.options.friction = 0.5, few.options.rolling_friction = 0.3;
  SteppedGrains s(few.make({{0.3, 0.0, few.resting_height(), 0.0}}));
  s.run(few.options.step, 20000);
  EXPECT_LT(s.at.velocity[0].norm(), 1e-5);
  EXPECT_LT(std::abs(s.at.position[0].x() - 0.3), 0.05 * few.options.radius);
  few.options.rolling_friction = 0.0;
  SteppedGrains rolls(few.make({{0.3, 0.0, few.resting_height(), 0.0}}));
  rolls.run(few.options.step, 10000);
  // A sphere that rolls without slip falls at 5/7 g sin α.
  EXPECT_NEAR(rolls.at.velocity[0].x() / (5.0 / 7.0 * 9.81 * std::sin(0.1) * 0.2), 1.0, 5e-3);
}

TEST(GpuGrains, falls_on_a_surface_that_was_far_and_rests_there_with_its_weight) {
  FewGrains few = mixed("mindlin");
  few.gravity = 9.81;
  const double r = few.options.radius, top = 0.1, dt = few.options.step;
  SteppedGrains s(few.make({{0.31, 0.01, top + 5.0 * r, 0.0}}));
  const testing::Surface plate = testing::sheet(0.25, -0.05, 0.02, 5, 5, [=](double, double) { return top; });
  const ContactMaterial material = dem::grain_material(few.options);
  TireOnGpu tire(s.grains, 0, plate.mesh, material, testing::at_rest(plate), r,
                 SurfacePatches(plate.mesh, plate.vertex, r));
  s.grains.set_surface_coefficients(0, few.coefficients().floor, false);
  NodalForces forces;
  ContactSums sums;
  for (int k = 0; k < 600; ++k) {
    tire.set_target(testing::at_rest(plate), 50 * dt);
    tire.send(s.grains, {Vec3(0.0, -0.3, 0.0), Vec3(0.6, 0.3, 1.0)});
    ASSERT_EQ(s.grains.run({50, dt, dt, 0.0, 0.02, INFINITY, k < 100 ? 0.0 : 20.0}).stop, Stop::none);
    tire.finish(s.grains, forces, sums);
  }
  const double weight = few.mass() * 9.81;
  EXPECT_NEAR(sums.force.z(), -weight, 1e-3 * weight);
  EXPECT_EQ(sums.contacts, 1);
  EXPECT_LE(forces.vertex.size(), 3U);
  s.at = s.grains.motion(true);
  EXPECT_NEAR(top + r - s.at.position[0].z(), few.resting_overlap(), 1e-3 * few.resting_overlap());
}

TEST(GpuGrains, closes_the_account_of_energy) {
  for (const char* law : {"mindlin", "hertz_tanh"}) {
    FewGrains few = mixed(law);
    few.options.rolling_friction = 0.1;
    const GrainSolver solver = cloud(few, 5, 5, 4, 0.3, 10.0);
    SteppedGrains s(solver);
    const double dt = 2e-6, m = few.mass();
    const double inertia = dem::grain_properties(few.options.radius, few.options.density).inertia;
    const auto stored = [&](const Sums& u) {
      return 0.5 * m * u.speed2 + 0.5 * inertia * u.spin2 + u.elastic + u.tangential;
    };
    const double before = stored(s.grains.sums(false, dt));
    double lost = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const Sums now = s.grains.sums(true, dt);
      for (const double one : now.losses) lost += dt * one;
      s.run(dt, 1);
    }
    const double after = stored(s.grains.sums(false, dt));
    EXPECT_GT(lost, 0.05 * before) << law;
    EXPECT_NEAR(before - after, lost, 0.01 * lost) << law;
  }
}

}  // namespace
}  // namespace furrow::terrain::gpu
