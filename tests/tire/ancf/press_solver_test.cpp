// Static pressing: force is the derivative of the potential, loading and unloading coincide, wrinkled tires come to
// rest.
#include "tire/ancf/press_solver.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "small_tire.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {
namespace {

std::unique_ptr<tire::PressSolver> solver_of(const tire::TireFile& file, const tire::PressObstacle& obstacle) {
  const tire::ShellMesh mesh = tire::make_shell_mesh(file);
  tire::InflationReport report;
  return std::make_unique<tire::PressSolver>(file, mesh, tire::inflate(tire::ShellCarcass(file, mesh), mesh, report),
                                             obstacle);
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
  // A contact layer so soft that the tire is rigid in comparison: springs in parallel.
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

tire::PressObstacle tilted(tire::PressObstacle obstacle, double camber) {
  obstacle.camber = camber;
  return obstacle;
}

TEST(PressSolver, at_camber_force_and_overturning_moment_are_derivatives_of_the_potential) {
  const tire::TireFile file = small_file("hmmwv_lumped.json", 30, 8);
  const double camber = 0.06, d = 0.012, turn = 2e-5;  // rad, m, rad
  for (const tire::PressObstacle& flat : {tire::PressObstacle{}, cleat()}) {
    const auto solver = solver_of(file, tilted(flat, camber));
    const double step = 1e-5;
    solver->press(d - step);
    const double before = solver->potential();
    const tire::PressPoint middle = solver->press(d);
    const double there = solver->potential();
    solver->press(d + step);
    EXPECT_NEAR((solver->potential() - before) / (2.0 * step) / middle.force, 1.0, 1e-5);
    EXPECT_EQ(middle.rim.force.z(), middle.force);
    EXPECT_NEAR(middle.rim.force.y(), 0.0, 1e-12 * middle.force);  // no friction
    // The wheel is turned about its centre, which keeps its height: the turning moment does the work −M dγ.
    double turned[2];
    for (const int side : {0, 1}) {
      const auto other = solver_of(file, tilted(flat, camber + (side == 0 ? -turn : turn)));
      other->press(d - solver->start_height() + other->start_height());
      turned[side] = other->potential();
      EXPECT_NEAR(turned[side] / there, 1.0, 0.1);
    }
    EXPECT_NEAR((turned[1] - turned[0]) / (2.0 * turn) / -middle.rim.moment.x(), 1.0, 1e-3);
    EXPECT_LT(middle.rim.moment.x(), -1.0);  // leaning to the right it stands on its right shoulder
  }
}

TEST(PressSolver, opposite_cambers_are_mirror_images) {
  const tire::TireFile file = small_file("hmmwv_lumped.json", 30, 8);
  tire::PressObstacle aside = cleat();
  aside.position = 0.02;
  for (const tire::PressObstacle& flat : {tire::PressObstacle{}, aside}) {
    tire::PressPoint point[2];
    tire::GroundStiffness stiffness[2];
    double sideways[2];
    for (const int k : {0, 1}) {
      const auto solver = solver_of(file, tilted(flat, k == 0 ? 0.08 : -0.08));
      point[k] = solver->press(0.012);
      stiffness[k] = solver->ground_stiffness();
      sideways[k] = 0.0;
      for (const tire::PressSample& s : solver->footprint()) sideways[k] += s.y * s.area * s.pressure;
    }
    EXPECT_NEAR(point[1].force / point[0].force, 1.0, 1e-6);
    EXPECT_NEAR(point[0].rim.moment.x() / sideways[0], 1.0, flat.height > 0.0 ? 1e-2 : 1e-9);
    EXPECT_NEAR(sideways[1] / sideways[0], -1.0, 1e-5);
    const Vec3 mirror(-1.0, 1.0, -1.0);  // of a moment, in the plane of the wheel
    const Vec3 off = point[1].rim.moment - mirror.cwiseProduct(point[0].rim.moment);
    EXPECT_LT(off.norm(), 1e-5 * point[0].rim.moment.norm());
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) {
        const double sign = (r % 2 == 0) == (c % 2 == 0) ? 1.0 : -1.0;  // y and the turn about z change sign
        EXPECT_NEAR(stiffness[1](r, c), sign * stiffness[0](r, c),
                    1e-5 * std::sqrt(stiffness[0](r, r) * stiffness[0](c, c)))
            << r << " " << c;
      }
  }
}

TEST(PressSolver, small_camber_changes_the_force_by_its_square_and_the_moment_in_proportion) {
  const tire::TireFile file = small_file("hmmwv_lumped.json", 30, 12);
  double force[3], moment[3];
  for (const int k : {0, 1, 2}) {
    const auto solver = solver_of(file, tilted({}, 2e-3 * k));
    solver->press(0.006);
    const tire::PressPoint point = solver->press(0.012 + solver->start_height() - solver_of(file, {})->start_height());
    force[k] = point.force, moment[k] = point.rim.moment.x();
  }
  EXPECT_LT(std::abs(moment[0]), 1e-6 * std::abs(moment[1]));
  EXPECT_NEAR(moment[2] / moment[1], 2.0, 0.02);
  EXPECT_LT(std::abs(force[1] / force[0] - 1.0), 1e-3);
  EXPECT_NEAR((force[2] - force[0]) / (force[1] - force[0]), 4.0, 0.4);
}

TEST(PressSolver, a_torus_touches_a_tilted_plate_where_geometry_says) {
  tire::TireFile file = small_file("toroidal.json", 96, 12);
  file.pressure = 1.0;
  const double ring = 0.35, section = 0.195;  // radii of the half torus, m
  const tire::ShellMesh mesh = tire::make_shell_mesh(file);
  for (const int aside : {1, 2}) {  // rows of nodes next to the middle: one of them is the lowest
    const Vec3 node = mesh.position[static_cast<std::size_t>(mesh.rows / 2 + aside)];
    const double camber = std::atan2(node.y(), node.z() - ring);
    ASSERT_GT(camber, 0.05);
    const auto solver = solver_of(file, tilted({}, camber));
    EXPECT_NEAR(solver->start_height(), ring * std::cos(camber) + section, 1e-5);
    const tire::PressPoint point = solver->press(2.5e-3);  // facets lie up to 2 mm above the lowest node
    EXPECT_NEAR(point.rim.moment.x() / point.force / (ring * std::sin(camber)), 1.0, 1e-2);
  }
}

TEST(PressSolver, an_axisymmetric_tire_has_no_runout) {
  const auto solver = solver_of(small_file("hmmwv_lumped.json", 30, 6), {});
  EXPECT_EQ(solver->press(0.0).failed_factorizations, 0);
  EXPECT_LT(solver->runout(), 1e-12);
  EXPECT_LT(solver->director_runout(), 1e-7);  // acos of a rounding error
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
