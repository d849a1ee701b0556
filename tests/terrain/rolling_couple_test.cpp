// The rolling couple between grains and triangulated surfaces: loads on vertices, and a grain's motion.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/constants.hpp"
#include "terrain/surface/surface_patches.hpp"
#include "tests/terrain/few_grains.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

/// Force, moment and power that a couple gives to vertices.
struct Given {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double power = 0.0, largest = 0.0;

  Given(std::span<const int> patch, const Vec3& couple, const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
    const PatchCouple on_patch = PatchTurn(patch, x).couple(couple);
    for (const int a : patch) {
      const Vec3 f = on_patch.force_at(x[a]);
      force += f;
      moment += x[a].cross(f);
      power += f.dot(v[a]);
      largest = std::max(largest, f.norm());
    }
  }
};

TEST(SurfacePatches, couple_is_handed_over_without_a_resultant_and_with_its_power) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  for (const double thin : {1.0, 1e-2, 1e-3}) {
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<Vec3> x(3), v(3);
      const Vec3 along = vector().normalized();
      for (int a = 0; a < 3; ++a) {
        const Vec3 at = vector();
        x[a] = 0.01 * (at.dot(along) * along + thin * (at - at.dot(along) * along));
        v[a] = vector();
      }
      const std::vector<int> all{0, 1, 2};
      const PatchTurn patch(all, x);
      const Vec3 couple = 0.05 * vector();
      const Given given(all, couple, x, v);
      ASSERT_LT(given.force.norm(), 5e-12 * given.largest) << thin;
      ASSERT_LT((given.moment - couple).norm(), 5e-12 * (couple.norm() + given.largest * 0.01)) << thin;
      double speeds = 0.0;
      for (const Vec3& u : v) speeds += u.norm();
      ASSERT_NEAR(given.power, couple.dot(patch.spin(v)), 1e-12 * given.largest * speeds / thin) << thin;
      const Vec3 turn = 100.0 * vector();
      for (int a = 0; a < 3; ++a) v[a] = Vec3(3.0, -2.0, 1.0) + turn.cross(x[a]);
      ASSERT_LT((patch.spin(v) - turn).norm(), 1e-10 * turn.norm() / (thin * thin)) << thin;
    }
  }
}

/// J⁻¹ by Eigen's decomposition, for patches of 3 to 11 vertices from nearly flat to thick, far from the origin.
TEST(SurfacePatches, turn_as_an_independent_solution_says) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 3 + trial % 9;
    const double flat = trial % 3 == 0 ? 1e-9 : trial % 3 == 1 ? 1e-2 : 1.0;
    std::vector<Vec3> x, v;
    std::vector<int> all;
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < count; ++k) {
      x.emplace_back(0.02 * any(random) + 9.0, 0.02 * any(random), 0.02 * flat * any(random));
      v.emplace_back(any(random), any(random), any(random));
      all.push_back(k);
      centre += x.back() / count;
    }
    Mat3 j = Mat3::Zero();
    Vec3 circulation = Vec3::Zero();
    for (int k = 0; k < count; ++k) {
      const Vec3 arm = x[k] - centre;
      j += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
      circulation += arm.cross(v[k]);
    }
    const PatchTurn patch(all, x);
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(j);
    ASSERT_EQ(axes.info(), Eigen::Success);
    const auto solved = [&](const Vec3& b) {
      const Vec3 along = axes.eigenvectors().transpose() * b;
      return Vec3(axes.eigenvectors() * along.cwiseQuotient(axes.eigenvalues()));
    };
    const Vec3 spin = solved(circulation), couple(any(random), any(random), any(random)), turn = solved(couple);
    EXPECT_LT((patch.spin(v) - spin).norm(), 1e-8 * spin.norm()) << trial;
    EXPECT_LT((patch.couple(couple).turn - turn).norm(), 1e-8 * turn.norm()) << trial;
    const Given given(all, couple, x, v);
    EXPECT_LT(given.force.norm(), 1e-9 * turn.norm() * 0.02 * count) << trial;
    EXPECT_LT((given.moment - couple).norm(), 1e-7) << trial;
  }
}

TEST(SurfacePatches, facet_smaller_than_the_grain_takes_its_neighbours_along) {
  const testing::Surface fine = testing::sheet(-0.05, -0.05, 0.002, 50, 50, [](double, double) { return 0.0; });
  const testing::Surface coarse = testing::sheet(-0.05, -0.05, 0.05, 2, 2, [](double, double) { return 0.0; });
  const double reach = 0.006;
  const SurfacePatches small(fine.mesh, fine.vertex, reach), large(coarse.mesh, coarse.vertex, reach);
  EXPECT_EQ(large.of(3).size(), 3U);
  const int middle = 50 * 50;
  EXPECT_GE(small.of(middle).size(), 20U);
  const std::vector<Vec3> still(fine.vertex.size(), Vec3::Zero());
  const Vec3 couple(0.0, 0.02, 0.0);
  const Given given(small.of(middle), couple, fine.vertex, still);
  EXPECT_LT(given.largest, couple.norm() / reach);  // a facet alone would get four times as much
}

namespace few {
using namespace dem;

/// A grain on a sheet that falls along x by `slope`; the sheet has its own rolling friction.
struct Slope {
  static constexpr double kLevel = 0.2;  // of the sheet, m

  Slope(double slope, double friction, double rolling) {
    grains.gravity = kStandardGravity;
    grains.slope = slope;
    grains.options.friction = friction;
    grains.options.step = 2e-6;
    material = grain_material(grains.options);
    material.cohesion = 0.0;
    material.rolling_friction = rolling;
  }

  GrainSolver make() {
    const double r = grains.options.radius;
    const GrainProperties grain = grain_properties(r, grains.options.density);
    const double load = grain.mass * kStandardGravity * std::cos(grains.slope);
    const double overlap = std::pow(load / grains.floor_stiffness(), 2.0 / 3.0);
    GrainSolver solver = grains.make({{0.2, 0.01, kLevel + r - overlap, 0.0}});
    const testing::Surface sheet = testing::sheet(0.0, -0.2, 0.05, 12, 8, [](double, double) { return kLevel; });
    state.position = sheet.vertex;
    state.velocity.assign(sheet.vertex.size(), Vec3::Zero());
    solver.surfaces().attach(sheet.mesh, material, mix(material, material, Partner::surface, grain, grains.options),
                             state);
    solver.surfaces().restrict_to({Vec3(-1, -1, 0), Vec3(2, 2, 1)});
    return solver;
  }

  void step(GrainSolver& solver, int count) {
    for (int k = 0; k < count; ++k) {
      solver.surfaces().set_targets({&state, 1}, grains.options.step);
      solver.surfaces().move_to(0.0);
      ASSERT_EQ(solver.step(grains.options.step), -1);
      solver.surfaces().move_to(1.0);
      solver.surfaces().finish(grains.options.step, forces, sums);
    }
  }

  FewGrains grains;
  ContactMaterial material;
  SurfaceState state;
  std::vector<NodalForces> forces{1};
  std::vector<ContactSums> sums{1};
};

// A force F through the centre: the point of contact stays if the couple that brakes is smaller than what friction can
// hold, F − m a ≤ μ N. With μ_r > μ the grain slides without turning, a = F/m − μ N/m; else it rolls with
// a = (F − μ_r N)/(1.4 m), since the couple μ_r r N takes μ_r N of F and 0.4 m r² of inertia turn with it.
TEST(RollingCouple, grain_dragged_through_its_centre_slides_or_rolls_as_theory_says) {
  for (const auto& [friction, rolling] : {std::pair{0.5, 0.0}, {0.5, 0.1}, {0.5, 0.3}, {0.2, 0.4}}) {
    Slope on(std::atan(0.45), friction, rolling);
    GrainSolver s = on.make();
    on.step(s, 5000);
    const double from = velocity(s, 0).x();
    on.step(s, 5000);
    const double g = kStandardGravity * std::cos(on.grains.slope), drive = kStandardGravity * std::sin(on.grains.slope);
    const double acceleration = (velocity(s, 0).x() - from) / (5000 * on.grains.options.step);
    const bool slides = rolling > friction;
    const double expected = slides ? drive - friction * g : (drive - rolling * g) / 1.4;
    EXPECT_NEAR(acceleration, expected, 5e-3 * kStandardGravity) << friction << ' ' << rolling;
    const double turns = spin(s, 0).y() * on.grains.options.radius / velocity(s, 0).x();
    EXPECT_NEAR(turns, slides ? 0.0 : 1.0, 0.02) << friction << ' ' << rolling;
  }
}

TEST(RollingCouple, single_grain_resists_the_smaller_of_both_frictions) {
  for (const auto& [friction, rolling] : {std::pair{0.5, 0.3}, {0.2, 0.4}}) {
    for (const double share : {0.9, 1.1}) {
      Slope on(std::atan(share * std::min(friction, rolling)), friction, rolling);
      GrainSolver s = on.make();
      on.step(s, 40000);
      const double moved = position(s, 0).x() - 0.2;
      EXPECT_EQ(moved > 2e-5, share > 1.0) << friction << ' ' << rolling << ' ' << share << ' ' << moved;
    }
  }
}

// The spring of the couple turns with facet and normal.
TEST(RollingCouple, grain_stuck_to_a_wheel_that_turns_keeps_its_spring_forces) {
  FewGrains few;
  few.options.friction = 0.9;
  few.options.rolling_friction = 0.9;
  few.options.step = 2e-6;
  ContactMaterial material = grain_material(few.options);
  material.cohesion = 0.0;
  const double r = few.options.radius, wheel = 0.1, spin_rate = 100.0;
  const Vec3 hub(0.3, 0.0, 0.3);
  const auto held = [&](const GrainSolver& s) {
    Archive archive;
    s.save(archive);
    std::vector<SurfaceHistory> history;
    restore_value(archive, "surfaces/history", history);
    EXPECT_EQ(history.size(), 1U);
    return std::pair(vec(history.at(0).tangential).norm(), vec(history.at(0).rolling).norm());
  };
  // The grain sits at the middle of a facet of a closed box, which turns about y with it.
  const testing::Surface box = testing::box(Vec3::Constant(-wheel), Vec3::Constant(wheel));
  const Vec3 place(0.31 * wheel, 0.17 * wheel, wheel + r - 0.01 * r);
  GrainSolver s = few.make({quad(hub + place)});
  SurfaceState state = testing::placed(box, hub, Vec3::Zero());
  const GrainProperties grain = grain_properties(r, few.options.density);
  s.surfaces().attach(box.mesh, material, mix(material, material, Partner::surface, grain, few.options), state);
  s.surfaces().restrict_to({Vec3(-1, -1, -1), Vec3(2, 2, 2)});
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  const auto step = [&](double turn, double rate, const Vec3& extra_velocity, const Vec3& extra_spin) {
    const double dt = few.options.step, after = turn + rate * dt;
    const Vec3 arm = Eigen::AngleAxisd(turn, Vec3::UnitY()) * place;
    const Vec3 arm_after = Eigen::AngleAxisd(after, Vec3::UnitY()) * place;
    s.grains().position[0] = {hub.x() + arm.x(), hub.y() + arm.y(), hub.z() + arm.z(), r};
    set_velocity(s, 0, (arm_after - arm) / dt + extra_velocity);
    set_spin(s, 0, Vec3(0.0, rate, 0.0) + extra_spin);
    state = testing::placed(box, hub, Vec3::Zero(), turn);
    const SurfaceState to = testing::placed(box, hub, Vec3::Zero(), after);
    for (std::size_t a = 0; a < to.position.size(); ++a) state.velocity[a] = (to.position[a] - state.position[a]) / dt;
    s.surfaces().set_targets({&state, 1}, dt);
    s.surfaces().move_to(0.0);
    ASSERT_EQ(s.step(few.options.step), -1);
    s.surfaces().move_to(1.0);
    s.surfaces().finish(few.options.step, forces, sums);
  };
  for (int k = 0; k < 20; ++k) step(0.0, 0.0, Vec3(2e-3, 3e-3, 0.0), Vec3(1.0, 2.0, 0.0));
  const auto [drag, couple] = held(s);
  ASSERT_GT(drag, 0.0);
  ASSERT_GT(couple, 0.0);
  const int steps = static_cast<int>(2.0 * std::numbers::pi / (spin_rate * few.options.step));
  for (int k = 0; k < steps; ++k) step(spin_rate * few.options.step * k, spin_rate, Vec3::Zero(), Vec3::Zero());
  const auto [drag_after, couple_after] = held(s);
  EXPECT_NEAR(drag_after / drag, 1.0, 1e-3);
  EXPECT_NEAR(couple_after / couple, 1.0, 1e-3);
}

}  // namespace few
}  // namespace
}  // namespace furrow::terrain
