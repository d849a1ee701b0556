// A rigid wheel on empirical soil against the integrals of Bekker, Wong & Reece and Janosi
// (terrain/soil/bekker_wong.hpp).
//
// With the largest pressure at the lowest point (c₁ = c₂ = 0), the theory's stresses are those of the engine, except
// for the rebound behind that point. With Wong & Reece's θ_m the largest pressure is farther ahead and the pull is
// lower. Soil that is pressed node by node does not have this effect.
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/soil/bekker_wong.hpp"
#include "tests/terrain/scm/driven_surface.hpp"

namespace furrow::terrain::scm {
namespace {

using testing::DrivenSurface;

constexpr double kRadius = 0.25, kWheelWidth = 0.1;

ScmOptions track() {
  ScmOptions options;
  options.length = 1.4;
  options.width = 0.2;
  options.grid_spacing = 0.005;
  options.patch_width = kWheelWidth;  // as in the theory
  options.bekker_k_c = 0.99e3;
  options.bekker_k_phi = 1528.43e3;
  options.bekker_n = 1.1;
  options.mohr_cohesion = 1040.0;
  options.mohr_friction_angle = 28.0;
  options.unloading_stiffness_rate = 1e11;  // hardly springs back
  options.rebound_damping = 0.0;
  return options;
}

struct Steady {
  double lift = 0.0, pull = 0.0, torque = 0.0;  // means, N, N m
  double residual = 0.0, work = 0.0;            // of the whole way, J
};

/// Lowers a wheel by `sinkage` as it rolls, lets it roll on, and takes means over whole facets.
Steady roll(const ScmOptions& options, double sinkage, double slip, double dt = 1e-3) {
  const auto ground = make_scm_ground(options);
  constexpr int kFacets = 120;
  DrivenSurface wheel{testing::wheel(kRadius, kWheelWidth, kFacets, 2), {0.3, 0.0, kRadius}};
  wheel.attach(*ground, 10.0);
  const double speed = 0.5, spin = speed / ((1.0 - slip) * kRadius);
  const int down = static_cast<int>(std::lround(0.3 / speed / dt)), on = down;
  const double facet = 2.0 * M_PI / kFacets / spin / dt;  // steps
  const int average = static_cast<int>(std::lround(8.0 * facet));
  Steady mean;
  for (int i = 0; i < down + on + average; ++i) {
    wheel.move(*ground, {speed, 0.0, i < down ? -sinkage / (down * dt) : 0.0}, spin, dt);
    if (i < down + on) continue;
    mean.lift += wheel.sums.force.z() / average;
    mean.pull += wheel.sums.force.x() / average;
    mean.torque -= wheel.moment().y() / average;
  }
  mean.residual = testing::residual(*ground);
  mean.work = ground->gather_state().energies.surface_work;
  return mean;
}

soil::WheelEstimate theory(const ScmOptions& o, double load, double slip, double c1, double c2) {
  const soil::SoilStrength soil{.k_c = o.bekker_k_c,
                                .k_phi = o.bekker_k_phi,
                                .n = o.bekker_n,
                                .cohesion = o.mohr_cohesion,
                                .phi = o.mohr_friction_angle * M_PI / 180.0,
                                .K = o.janosi_k};
  return soil::rigid_wheel(soil, {.radius = kRadius, .width = kWheelWidth, .load = load, .c1 = c1, .c2 = c2}, slip);
}

TEST(ScmWheel, pulls_and_sinks_as_the_integrals_of_its_stresses_say) {
  for (const double slip : {0.05, 0.2, 0.5}) {
    const Steady found = roll(track(), 0.03, slip);
    const soil::WheelEstimate same = theory(track(), found.lift, slip, 0.0, 0.0);
    const soil::WheelEstimate reece = theory(track(), found.lift, slip, 0.4, 0.2);
    ASSERT_TRUE(same.found && reece.found);
    std::printf(
        "slip %.2f: load %.0f N; sinkage 30.0 mm, theory %.1f, with theta_m %.1f; pull %.1f N, %.1f, %.1f; "
        "torque %.1f N m, %.1f, %.1f\n",
        slip, found.lift, 1e3 * same.sinkage, 1e3 * reece.sinkage, found.pull, same.pull, reece.pull, found.torque,
        same.torque, reece.torque);
    EXPECT_NEAR(same.sinkage / 0.03, 1.0, 0.02) << slip;
    EXPECT_NEAR((found.pull - same.pull) / found.lift, 0.0, 0.02) << slip;
    EXPECT_NEAR(found.torque / same.torque, 1.0, 0.03) << slip;
    EXPECT_GT(found.pull, reece.pull) << slip;
  }
}

TEST(ScmWheel, accounts_close_better_with_a_smaller_step) {
  ScmOptions options = track();
  options.unloading_stiffness_rate = 5.03e8;
  const Steady coarse = roll(options, 0.03, 0.2, 2e-3), fine = roll(options, 0.03, 0.2, 5e-4);
  std::printf("residual/work: %.4f at 2 ms, %.4f at 0.5 ms\n", coarse.residual / coarse.work,
              fine.residual / fine.work);
  EXPECT_LT(std::abs(fine.residual), 0.01 * fine.work);
  EXPECT_LT(std::abs(fine.residual), 0.6 * std::abs(coarse.residual));
}

TEST(ScmWheel, meets_less_resistance_in_the_rut_of_another) {
  const auto ground = make_scm_ground(track());
  double resistance[2];
  DrivenSurface wheel{testing::wheel(kRadius, kWheelWidth, 120, 2), {0.3, 0.0, kRadius}};
  wheel.attach(*ground, 0.0);  // without friction the horizontal force is the resistance of compaction
  for (double& one : resistance) {
    one = 0.0;
    wheel.position = Vec3(0.3, 0.0, kRadius + 0.05);
    for (int i = 0; i < 10; ++i) wheel.move(*ground, Vec3::Zero(), 0.0, 1e-3);
    for (int i = 0; i < 100; ++i) wheel.move(*ground, {0.0, 0.0, -0.7}, 0.0, 1e-3);
    for (int i = 0; i < 600; ++i) {
      wheel.move(*ground, {1.0, 0.0, 0.0}, 4.0, 1e-3);
      if (i >= 400) one -= wheel.sums.force.x() / 200.0;
    }
  }
  EXPECT_GT(resistance[0], 10.0);
  EXPECT_LT(resistance[1], 0.1 * resistance[0]);
  const ScmOptions o = track();
  const double b_k = kWheelWidth * (o.bekker_k_c / kWheelWidth + o.bekker_k_phi);
  EXPECT_NEAR(resistance[0] / (b_k * std::pow(0.02, 2.1) / 2.1), 1.0, 0.05);  // Bekker's b k zⁿ⁺¹/(n + 1)
}

}  // namespace
}  // namespace furrow::terrain::scm
