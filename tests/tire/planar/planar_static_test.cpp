// The planar wheel at rest: balance, work, symmetry, and small loads against the linear solution.
#include "tire/planar/planar_static.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/tire/planar/planar_examples.hpp"
#include "tests/tire/planar/planar_wheel.hpp"

namespace furrow::tire {
namespace {

PlanarParams wheel(int around = 36, int rings = 4) {
  PlanarParams p;
  p.size = {.radius = 0.5, .rim_radius = 0.25, .rings = rings, .around = around};
  p.disc = {740.0, 1e8, 0.3, 0.0}, p.tire = {100.0, 3e5, 0.45, 0.0};
  p.contact_stiffness = 1e7;
  return p;
}

double reach(const PlanarStatic& s) { return s.contact().ground().top() + 0.5; }

TEST(PlanarStatic, ground_and_axle_are_in_balance_and_the_force_is_the_derivative_of_the_energy) {
  for (const bool averaged : {false, true}) {
    PlanarParams p = wheel();
    p.options.averaged = averaged;
    PlanarStatic s(p, PlanarGround::plate(0.5));
    const auto energy = [&](double deflection) {
      const PlanarReport report = s.move_to({0.0, reach(s) - deflection});
      EXPECT_TRUE(report.converged) << deflection << " " << report.residual;
      return s.elements().energy(s.shape()) + s.contact().energy();
    };
    EXPECT_NEAR(energy(0.0), 0.0, 1e-7);
    EXPECT_EQ(s.force(), 0.0);
    const double h = 1e-5, before = energy(0.06 - h), after = energy(0.06 + h);
    energy(0.06);
    EXPECT_NEAR((after - before) / (2 * h), s.force(), 1e-5 * s.force());
    EXPECT_GT(s.force(), 1e4);
    // The axle carries the forces of the triangles around the centre node.
    PlanarElements elements = s.elements();
    PlanarField f(s.shape().size());
    EXPECT_TRUE(elements.force(s.shape(), PlanarField(f.size()), f));
    EXPECT_NEAR(f.z[0], s.force(), 1e-7 * s.force());
    EXPECT_NEAR(f.x[0], 0.0, 1e-7 * s.force());
    // When the centre returns, so does the force.
    const double there = s.force();
    energy(0.02), energy(0.06);
    EXPECT_NEAR(s.force(), there, 1e-7 * there);
  }
}

TEST(PlanarStatic, small_deflections_follow_the_linear_stiffness_at_the_lowest_node) {
  const PlanarParams p = wheel();
  PlanarStatic s(p, PlanarGround::plate(0.5));
  Eigen::MatrixXd k = assembled(s.elements(), s.mesh().position);
  const int low = 2 * s.mesh().outer[0] + 1, top = 2 * s.mesh().rim[18];  // against turning, without reaction
  for (const int held : {0, 1, top}) k.row(held).setZero(), k.col(held).setZero(), k(held, held) = 1.0;
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(k.rows());
  unit[low] = 1.0;
  const double stiffness = 1.0 / (k.llt().solve(unit)[low] + 1.0 / p.contact_stiffness);
  ASSERT_TRUE(s.move_to({0.0, reach(s) - 1e-6}).converged);
  EXPECT_EQ(s.contact().touches().size(), 1U);
  EXPECT_NEAR(s.force() / 1e-6, stiffness, 1e-3 * stiffness);
}

TEST(PlanarStatic, a_ground_that_the_lowest_node_sticks_to_feels_its_compliance) {
  const PlanarParams p = wheel();
  PlanarStatic s(p, PlanarGround::plate(0.5));
  Eigen::MatrixXd k = assembled(s.elements(), s.mesh().position);
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(k.rows());  // of the rim, which is held
  for (const int n : s.mesh().rim) turn[2 * n] = s.mesh().position.z[n], turn[2 * n + 1] = -s.mesh().position.x[n];
  k += 1e12 * turn * turn.transpose();
  for (const int held : {0, 1}) k.row(held).setZero(), k.col(held).setZero(), k(held, held) = 1.0;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(k.rows(), 2);
  for (const int d : {0, 1}) unit(2 * s.mesh().outer[0] + d, d) = 1.0;
  const Eigen::MatrixXd way = k.llt().solve(unit);
  Eigen::Matrix2d compliance = way.middleRows<2>(2 * s.mesh().outer[0]);
  compliance += Eigen::Matrix2d::Identity() / p.contact_stiffness;
  const Eigen::Matrix2d expected = compliance.inverse();
  ASSERT_TRUE(s.move_to({0.0, reach(s) - 1e-6}).converged);
  ASSERT_EQ(s.contact().touches().size(), 1U);
  const GroundStiffness found = s.ground_stiffness();
  EXPECT_NEAR(found(0, 0) / expected(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(found(2, 2) / expected(1, 1), 1.0, 1e-3);
  EXPECT_TRUE(std::isnan(found(1, 1)) && std::isnan(found(3, 3)));
}

TEST(PlanarStatic, stiffness_against_a_sliding_ground_is_the_slope_of_the_curve_and_a_soft_layer_its_springs) {
  for (const bool bar : {false, true}) {
    const PlanarParams p = wheel();
    PlanarStatic s(p, bar ? PlanarGround::bar(0.05, 0.0) : PlanarGround::plate(0.5));
    const auto force = [&](double deflection) {
      EXPECT_TRUE(s.move_to({0.0, reach(s) - deflection}).converged);
      return s.force();
    };
    const double h = 1e-6, before = force(0.05 - h), after = force(0.05 + h);
    const double there = force(0.05);
    const GroundStiffness sliding = s.ground_stiffness(0.0), stuck = s.ground_stiffness();
    EXPECT_NEAR(sliding(2, 2) / ((after - before) / (2.0 * h)), 1.0, 1e-4) << bar;
    EXPECT_GE(stuck(2, 2), sliding(2, 2));
    EXPECT_GT(stuck(0, 0), sliding(0, 0));
    EXPECT_EQ(force(0.05), there);  // nothing has been disturbed
    if (bar) continue;
    EXPECT_NEAR(sliding(0, 0), 0.0, 1e-9 * sliding(2, 2));
    const double soft = 1e-6, springs = soft * p.contact_stiffness * static_cast<double>(s.contact().touches().size());
    EXPECT_NEAR(s.ground_stiffness(soft)(0, 0) / springs, 1.0, 1e-3);
  }
}

TEST(PlanarStatic, what_is_pressed_symmetrically_needs_no_couple_and_a_bar_aside_one) {
  PlanarStatic plate(wheel(24, 3), PlanarGround::plate(0.5)), bar(wheel(24, 3), PlanarGround::bar(0.04, 0.1));
  for (PlanarStatic* s : {&plate, &bar}) {
    const PlanarReport report = s->move_to({0.0, reach(*s) - 0.05});
    ASSERT_TRUE(report.converged);
    if (s == &bar) break;  // nodes that slide over its edges take many
    EXPECT_LT(report.steps, 60);
    EXPECT_EQ(report.indefinite, 0);
  }
  // The mesh of the disc is not its own mirror image.
  EXPECT_LT(std::abs(plate.couple()), 5e-3 * 0.5 * plate.force());
  // Moment of the ground's forces about the centre, +y: z F_x − x F_z.
  double moment = 0.0;
  for (const PlanarTouch& t : bar.contact().touches()) {
    const int b = t.b < 0 ? t.a : t.b;
    const double x = (1 - t.share) * bar.shape().x[t.a] + t.share * bar.shape().x[b];
    const double z = (1 - t.share) * bar.shape().z[t.a] + t.share * bar.shape().z[b] - (reach(bar) - 0.05);
    moment += z * t.force * t.push_x - x * t.force * t.push_z;
  }
  EXPECT_GT(std::abs(moment), 10.0);
  EXPECT_NEAR(bar.rim().moment.y(), moment, 1e-9 * std::abs(moment));
  EXPECT_NEAR(bar.rim().force.z(), bar.force(), 1e-9 * bar.force());
  EXPECT_NEAR(bar.couple(), -moment, 1e-3 * std::abs(moment));  // the mean turn counts small turns
}

TEST(PlanarStatic, stiffness_is_in_proportion_to_modulus_and_width) {
  PlanarParams p = wheel(24, 3);
  const auto force = [&](double factor, double width) {
    PlanarParams q = p;
    q.tire.young_modulus *= factor, q.disc.young_modulus *= factor, q.contact_stiffness *= factor;
    q.options.width = width;
    PlanarStatic s(q, PlanarGround::plate(0.5));
    EXPECT_TRUE(s.move_to({0.0, reach(s) - 0.04}).converged);
    return s.force();
  };
  const double once = force(1.0, 1.0);
  EXPECT_NEAR(force(3.0, 1.0), 3.0 * once, 1e-6 * once);
  EXPECT_NEAR(force(1.0, 0.3), 0.3 * once, 1e-6 * once);
}

TEST(PlanarStatic, motion_comes_to_rest_where_it_says) {
  PlanarParams p = wheel(24, 3);
  p.disc.young_modulus = 1e7;
  p.tire.viscosity = 2000.0;
  p.contact_stiffness = 1e6;
  PlanarStatic s(p, PlanarGround::plate(0.5));
  ASSERT_TRUE(s.move_to({0.0, 0.47}).converged);
  PlanarWheel moving(p, PlanarGround::plate(0.5), {0.0, 0.4999}, {0.0, 0.0}, 0.0, 300.0, 0.0);
  PlanarLink link;
  link.hold_x = true, link.force_z = -s.force();
  moving.link(link);
  for (int k = 0; k * moving.step() < 2.0; ++k) ASSERT_TRUE(moving.advance().ok);
  EXPECT_NEAR(moving.centre().z, 0.47, 1e-4);
  EXPECT_NEAR(moving.contact().force_z(), s.force(), 1e-2 * s.force());
}

}  // namespace
}  // namespace furrow::tire
