// Static pressing: force and potential belong together, one path up and down, wrinkled tires come to rest.
#include "tire/ancf/press_solver.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "small_tire.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {
namespace {

std::unique_ptr<tire::PressSolver> solver_of(const tire::TireFile& file,
                                             const tire::PressObstacle& obstacle) {
  const tire::ShellMesh mesh = tire::make_shell_mesh(file);
  tire::InflationReport report;
  return std::make_unique<tire::PressSolver>(
      file, mesh, tire::inflate(tire::ShellCarcass(file, mesh), mesh, report), obstacle);
}

tire::PressObstacle cleat() {
  tire::PressObstacle bar;
  bar.height = bar.width = 0.02;
  bar.edge = 0.01;
  return bar;
}

TEST(PressSolver, force_is_the_derivative_of_the_potential) {
  for (const tire::PressObstacle& obstacle : {tire::PressObstacle{}, cleat()}) {
    const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), obstacle);
    const double d = 0.008, step = 1e-5;  // m
    solver->press(d - step);
    const double before = solver->potential();
    const tire::PressPoint middle = solver->press(d);
    solver->press(d + step);
    EXPECT_NEAR((solver->potential() - before) / (2.0 * step) / middle.force, 1.0, 1e-5);
    EXPECT_GT(middle.force, 500.0);
    double sum = 0.0;
    solver->press(d);
    for (const tire::PressSample& s : solver->footprint()) sum += s.area * s.pressure;
    EXPECT_NEAR(sum / middle.force, 1.0, 1e-6);
  }
}

TEST(PressSolver, unloads_along_the_loading_path) {
  for (const tire::PressObstacle& obstacle : {tire::PressObstacle{}, cleat()}) {
    const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), obstacle);
    std::vector<double> up;
    for (int k = 0; k <= 3; ++k) up.push_back(solver->press(0.004 * k).force);
    for (int k = 3; k >= 0; --k) {
      const tire::PressPoint point = solver->press(0.004 * k);
      EXPECT_NEAR(point.force, up[k], 1e-6 * up[3]);
      EXPECT_LE(point.residual, 1e-6);
    }
  }
}

TEST(PressSolver, stiffness_against_a_sliding_ground_is_the_slope_of_the_curve) {
  const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), {});
  const double d = 0.008, step = 2e-6;  // m
  const double before = solver->press(d - step).force, after = solver->press(d + step).force;
  solver->press(d);
  const tire::GroundStiffness s = solver->ground_stiffness(0.0);
  EXPECT_NEAR(s(2, 2) / ((after - before) / (2.0 * step)), 1.0, 1e-3);
  for (const int k : {0, 1, 3}) EXPECT_NEAR(s(k, k), 0.0, 1e-9 * s(2, 2)) << k;  // it slides
}

TEST(PressSolver, a_ground_that_the_tire_sticks_to_is_held_in_every_direction) {
  const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), {});
  const double force = solver->press(0.008).force;
  const tire::GroundStiffness sliding = solver->ground_stiffness(0.0), s = solver->ground_stiffness();
  EXPECT_GE(s(2, 2), sliding(2, 2) * (1.0 - 1e-9));
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(s(k, k), 0.0) << k;
    for (int l = 0; l < k; ++l)  // the tire is its own mirror image from the side and from the front
      EXPECT_NEAR(s(k, l), 0.0, 1e-6 * std::sqrt(s(k, k) * s(l, l))) << k << " " << l;
  }
  EXPECT_LT(s(1, 1), s(0, 0));  // a tire is softest sideways
  // A layer so soft that the tire is rigid beside it: its springs side by side.
  const double soft = 1e-6;
  double area = 0.0, turning = 0.0;
  for (const tire::PressSample& p : solver->footprint()) area += p.area, turning += p.area * (p.x * p.x + p.y * p.y);
  const tire::GroundStiffness layer = solver->ground_stiffness(soft);
  const double shear = soft * tire::PressObstacle{}.stiffness;  // N/m³
  EXPECT_NEAR(layer(0, 0) / (shear * area), 1.0, 2e-2);
  EXPECT_NEAR(layer(1, 1) / (shear * area), 1.0, 2e-2);
  EXPECT_NEAR(layer(3, 3) / (shear * turning), 1.0, 2e-2);
  EXPECT_EQ(solver->press(0.008).force, force);  // nothing has been disturbed
}

TEST(PressSolver, an_axisymmetric_tire_has_no_runout) {
  const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), {});
  EXPECT_EQ(solver->press(0.0).failed_factorizations, 0);
  EXPECT_LT(solver->runout(), 1e-12);
  EXPECT_LT(solver->director_runout(), 1e-7);  // acos of what rounding leaves
}

TEST(PressSolver, a_wrinkled_tire_comes_to_a_stable_rest) {
  const auto solver = solver_of(small_file("hmmwv_layered.json", 60, 12), {});
  EXPECT_GT(solver->press(0.0).failed_factorizations, 0);  // 200 kPa: the axisymmetric shape is not stable
  EXPECT_GT(solver->runout(), 1e-4);
  EXPECT_GT(solver->director_runout(), 1e-3);
  double last = 0.0;
  for (int k = 1; k <= 2; ++k) {
    const tire::PressPoint point = solver->press(0.003 * k);
    EXPECT_LE(point.residual, 1e-6);
    EXPECT_GT(point.force, last);
    last = point.force;
  }
}

}  // namespace
}  // namespace furrow::test
