// Long paths over a flat triangulated plane: no triangle edge may change force or history.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "protocol/core/constants.hpp"
#include "tests/terrain/surface_meshes.hpp"
#include "tests/terrain/verification/engine_grains.hpp"
#include "tests/verification/record.hpp"

namespace furrow::verification::sliding_block_test {
namespace {

using terrain::dem::GrainSolver;

constexpr double kRadius = 0.006;  // m

/// A flat sheet of 7 mm cells, turned and moved arbitrarily; its cells have no special position below the path along
/// its x axis.
testing::Surface plane_at(const Vec3& foot, const Quat& turn) {
  testing::Surface s = testing::sheet(-0.0313, -0.0332, 0.007, 90, 9, [](double, double) { return 0.0; });
  for (Vec3& x : s.vertex) x = foot + turn * x;
  return s;
}

/// Nine grains moved as one rigid block: only its height is free, under its weight.
TEST(SlidingBlock, feels_no_edge_in_half_a_metre) {
  EngineGrains few;
  few.options.friction = 0.4;
  few.options.restitution = 0.3;
  few.options.length = 1.0;
  const terrain::dem::ContactCoefficients k = few.coefficients().floor;
  const double mass = few.mass();
  constexpr int kGrains = 9;
  const double weight = kGrains * mass * kStandardGravity, speed = 0.5, dt = 2e-5, height = 0.05;
  const double rest = kRadius - std::pow(weight / kGrains / few.floor_stiffness(), 2.0 / 3.0);
  std::vector<terrain::dem::Quad> at;
  for (int n = 0; n < kGrains; ++n)
    at.push_back({0.1 + 0.0153 * (n % 3), 0.0153 * (n / 3) - 0.0147, height + rest, 0.0});
  terrain::dem::GrainSolver s = few.make(at);
  attach(s, plane_at({0.1, 0.0, height}, Quat::Identity()), k);
  Worst normal("block of 9 grains over a mesh, mindlin", "normal force over 0.5 m, N", 1e-3, "m g");
  Worst friction("block of 9 grains over a mesh, mindlin", "friction over 0.5 m, N", 1e-3, "mu m g");
  Worst across("block of 9 grains over a mesh, mindlin", "friction across over 0.5 m, N", 1e-3, "0");
  double sink = 0.0;
  Vec3 before = s.accounts().surface_impulse;
  for (int step = 0; step < 50000; ++step) {
    for (int n = 0; n < kGrains; ++n) {
      s.grains().velocity[n] = {speed, 0.0, sink, 0.0};
      s.grains().spin[n] = {};
    }
    ASSERT_EQ(s.step(dt), -1);
    const Vec3 force = (s.accounts().surface_impulse - before) / dt;
    before = s.accounts().surface_impulse;
    sink += dt * (force.z() - weight) / (kGrains * mass);
    if (step < 3000) continue;  // the spring builds up
    const std::string where = brief(speed * dt * step) + " m";
    normal.add(force.z(), weight, 0.0, where);
    friction.add(-force.x(), few.options.friction * weight, 0.0, where);
    across.add(force.y(), 0.0, weight, where);
  }
  EXPECT_GT(terrain::dem::position(s, 0).x(), 0.59);
}

/// Static friction of 2/7 of the downhill weight must act along the whole path, so history lost at one edge would be
/// visible.
TEST(SlidingBlock, sphere_rolls_half_a_metre_down_a_mesh_at_five_sevenths_g) {
  EngineGrains few;
  few.options.friction = 0.6;
  few.options.length = 1.0;
  few.gravity = kStandardGravity;
  const terrain::dem::ContactCoefficients k = few.coefficients().floor;
  const double mass = few.mass(), angle = 0.2, dt = 1e-5;
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  const Vec3 foot(0.1, 0.0, 0.3), down = turn * Vec3::UnitX(), up = turn * Vec3::UnitZ();
  const double load = mass * few.gravity * std::cos(angle);
  const double overlap = std::pow(load / few.floor_stiffness(), 2.0 / 3.0), arm = kRadius - overlap;
  terrain::dem::GrainSolver s = few.make({terrain::dem::quad(foot + arm * up)});
  attach(s, plane_at(foot, turn), k);
  // Rolling without slip on the arm r − δ: a = g sin α / (1 + I/(m arm²)), F_t = m g sin α − m a.
  const double pull = few.gravity * std::sin(angle);
  const double rolling = pull / (1.0 + 0.4 * kRadius * kRadius / (arm * arm));
  const std::string name = "sphere rolling down a mesh, mindlin";
  Worst friction(name, "static friction over 0.5 m, N", 1e-3, "m g sin(a)/(1 + m arm^2/I)");
  Worst normal(name, "normal force over 0.5 m, N", 1e-3, "m g cos(a)");
  Vec3 before = s.accounts().surface_impulse;
  int step = 0;
  for (; (terrain::dem::position(s, 0) - foot).dot(down) < 0.5 && step < 200000; ++step) {
    ASSERT_EQ(s.step(dt), -1);
    const Vec3 force = (s.accounts().surface_impulse - before) / dt;
    before = s.accounts().surface_impulse;
    if (step < 5000) continue;  // the spring is stretched and its start-up has died out
    const std::string where = brief((terrain::dem::position(s, 0) - foot).dot(down)) + " m";
    friction.add(-force.dot(down), mass * (pull - rolling), 0.0, where);
    normal.add(force.dot(up), load, 0.0, where);
  }
  const double time = step * dt;
  verify(name, "way after its time, m", (terrain::dem::position(s, 0) - foot).dot(down), 0.5 * rolling * time * time,
         1e-3, "5/7 g sin(a) t^2/2, with the arm r - delta");
}

/// A grain of 2000 t that keeps its velocity stretches Mindlin's spring while its contact crosses edges and a vertex.
TEST(SlidingBlock, sticking_contact_keeps_its_spring_across_edges_and_vertices) {
  for (const bool through_vertex : {false, true}) {
    EngineGrains few;
    few.options.friction = 1e3;
    few.options.restitution = 1.0;
    few.options.density = 2.5e12;
    const terrain::dem::ContactCoefficients k = few.coefficients().floor;
    const double mass = few.mass();
    const double overlap = 1e-4, speed = 0.02, dt = 1e-5, height = 0.05;
    // Cells of 10 mm: the path of 16 mm crosses diagonals and two cell borders, or runs through vertices.
    terrain::dem::GrainSolver s = few.make({{0.296, through_vertex ? 0.0 : 0.0037, height + kRadius - overlap}});
    testing::Surface mesh = testing::sheet(0.2, -0.05, 0.01, 20, 10, [=](double, double) { return height; });
    attach(s, mesh, k);
    Worst worst(std::string("sticking grain moved over a mesh") + (through_vertex ? ", along edges and vertices" : ""),
                "spring force, N", 1e-6, "Mindlin 1949, 8 G* sqrt(R delta) x displacement");
    const Vec3 way(speed, through_vertex ? 0.0 : 0.1 * speed, 0.0);
    for (int step = 1; step <= 80000; ++step) {
      s.grains().velocity[0] = terrain::dem::quad(way);
      s.grains().spin[0] = {};
      s.step(dt);
      const Vec3 force = mass / dt * (terrain::dem::velocity(s, 0) - way);
      if (step % 50 != 0) continue;
      const double spring =
          k.of<terrain::dem::MindlinLaw>().shear_stiffness * std::sqrt(overlap) * step * dt * way.norm();
      worst.add(-force.dot(way) / way.norm(), spring, 0.0, brief(step * dt * speed) + " m");
    }
  }
}

}  // namespace
}  // namespace furrow::verification::sliding_block_test
