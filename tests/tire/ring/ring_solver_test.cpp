// Equilibrium of the flexible ring on the ground: closed forms, its conditions, and its dependence on N.
#include "tire/ring/ring_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/tire/ring/ring_examples.hpp"
#include "tire/ring/ring_stiffness.hpp"

namespace furrow::tire {
namespace {

using std::numbers::pi;

/// Force after pressing to a deflection in equal steps; checks that each equilibrium is found.
double pressed(RingSolver& solver, double deflection, int steps, double x = 0.0) {
  for (int k = 1; k <= steps; ++k) {
    const RingReport report = solver.solve({x, solver.ring().radius() - deflection * k / steps});
    EXPECT_TRUE(report.converged) << k << " of " << steps << ": residual " << report.residual << ", penetration "
                                  << report.penetration << ", pull " << report.pull;
  }
  return solver.spindle_force().z;
}

RingGround plate(const RingParams& p) { return RingGround::plate(p.radius); }

TEST(RingSolver, without_contact_nothing_moves) {
  const RingParams p = truck_ring();
  RingSolver solver(p, plate(p));
  const RingReport report = solver.solve({0.0, solver.ring().radius() + 1e-3});
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.steps, 0);
  EXPECT_EQ(largest(solver.state()), 0.0);
  EXPECT_EQ(solver.spindle_force().z, 0.0);
}

/// u of one segment under a unit force on it, or v under one along it, from the Fourier series of the discrete ring;
/// `exact` waves are those of the continuous one.
double point_compliance(const RingParams& p, int terms, bool exact, bool along = false) {
  const double phi = 2.0 * pi / p.segments;
  const RingMechanics ring(p);
  const double air = p.ambient * std::pow(2.0 * pi * ring.radius() * p.width, 2) / ring.volume();
  double sum = 1.0 / (along ? 2.0 * pi * p.tangential : 2.0 * pi * p.sidewall_1 + air);
  for (int n = 1; n < terms; ++n) {
    const double s = exact ? n : std::sin(n * phi) / std::sin(phi),
                 c = exact ? 1.0 * n * n : (1.0 - std::cos(n * phi)) / (1.0 - std::cos(phi));
    const double uu = p.bending * c * c + p.shear * s * s + p.sidewall_1,
                 vv = p.bending * s * s + p.shear * c * c + p.tangential, uv = (p.bending + p.shear) * s * c;
    sum += (exact ? 1.0 / pi : 0.5 / pi) * (along ? uu : vv) / (uu * vv - uv * uv);
  }
  return sum;
}

TEST(RingSolver, the_linear_ring_touched_at_one_segment_answers_as_its_fourier_series) {
  for (const RingKinematics kinematics : {RingKinematics::exact, RingKinematics::radial})
    for (const int n : {64, 480, 481}) {
      RingParams p = linear_ring(n);
      p.kinematics = kinematics;
      RingSolver solver(p, plate(p));
      EXPECT_NEAR(pressed(solver, 1e-7, 1) * point_compliance(p, n, false), 1e-7, 1e-14) << n;
      for (int j = 1; j < n; ++j) EXPECT_FALSE(solver.contacts().segment[j]);
    }
  const RingParams fine = linear_ring(1920);
  RingSolver solver(fine, plate(fine));
  EXPECT_NEAR(pressed(solver, 1e-7, 1) * point_compliance(fine, 100000, true), 1e-7, 2e-11);
}

TEST(RingSolver, a_ground_that_one_segment_sticks_to_feels_its_compliance) {
  for (const int n : {64, 480, 481}) {
    const RingParams p = linear_ring(n);
    RingSolver solver(p, plate(p));
    pressed(solver, 1e-7, 1);
    const Eigen::Matrix2d s = ring_ground_stiffness(solver);
    EXPECT_NEAR(s(0, 0) * point_compliance(p, n, false, true), 1.0, 1e-7) << n;
    EXPECT_NEAR(s(1, 1) * point_compliance(p, n, false), 1.0, 1e-7) << n;
    EXPECT_NEAR(s(0, 1), 0.0, 1e-9 * s(1, 1));
  }
}

/// The ground stiffness from one dense system: all displacements and holding forces are unknowns.
Eigen::Matrix2d stuck_densely(const RingSolver& solver) {
  const RingMechanics& ring = solver.ring();
  const int n = ring.segments();
  RingTangent tangent = ring.no_tangent();
  ring.tangent(solver.state(), tangent);
  Eigen::MatrixXd k(2 * n, 2 * n);
  for (int c = 0; c < 2 * n; ++c) {
    RingField unit = ring.zero();
    (c % 2 == 0 ? unit.u : unit.v)[c / 2] = 1.0;
    for (int j = 0; j < n; ++j) {
      const std::array<double, 2> row = tangent_row(tangent, unit, c % 2 == 0 ? 1.0 : 0.0, j);
      k(2 * j, c) = row[0], k(2 * j + 1, c) = row[1];
    }
  }
  std::vector<Eigen::MatrixXd> holds;  // displacement of the belt along x and z where it is held
  const auto hold = [&](int first, const std::vector<double>& share) {
    Eigen::MatrixXd way = Eigen::MatrixXd::Zero(2, 2 * n);
    for (int i = 0; i < static_cast<int>(share.size()); ++i) {
      const int j = (first + i) % n;
      const double s = std::sin(j * ring.angle()), c = std::cos(j * ring.angle());
      way(0, 2 * j) = share[i] * s, way(0, 2 * j + 1) = share[i] * c;
      way(1, 2 * j) = -share[i] * c, way(1, 2 * j + 1) = share[i] * s;
    }
    holds.push_back(way);
  };
  for (int j = 0; j < n; ++j)
    if (solver.contacts().segment[j]) hold(j, {1.0});
  for (std::size_t c = 0; c < solver.corner_gaps().size(); ++c)
    if (solver.contacts().corner[c]) {
      const CornerGap& gap = solver.corner_gaps()[c];
      hold(gap.first, {gap.share.begin(), gap.share.end()});
    }
  const int held = 2 * static_cast<int>(holds.size());
  const double scale = k(0, 0);  // N/m: rows of one size, which the pivots need
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n + held, 2 * n + held),
                  right = Eigen::MatrixXd::Zero(2 * n + held, 2);
  all.topLeftCorner(2 * n, 2 * n) = k;
  for (int h = 0; h < held / 2; ++h) {
    all.block(2 * n + 2 * h, 0, 2, 2 * n) = scale * holds[h];
    all.block(0, 2 * n + 2 * h, 2 * n, 2) = -scale * holds[h].transpose();
    right.block<2, 2>(2 * n + 2 * h, 0) = scale * Eigen::Matrix2d::Identity();
  }
  const Eigen::MatrixXd found = all.fullPivLu().solve(right);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int h = 0; h < held / 2; ++h) sum += scale * found.block<2, 2>(2 * n + 2 * h, 0);
  return sum;
}

TEST(RingSolver, a_pressed_ring_that_sticks_resists_as_one_dense_system_says) {
  for (const RingKinematics kinematics : {RingKinematics::exact, RingKinematics::radial})
    for (const double width : {0.0, 0.025, 0.1}) {
      RingParams p = truck_ring(120);
      p.kinematics = kinematics;
      RingSolver solver(p, width > 0.0 ? RingGround::bar(width, 0.01) : plate(p));
      const double before = pressed(solver, 0.03 - 1e-6, 3), force = pressed(solver, 0.03, 1);
      const Eigen::Matrix2d s = ring_ground_stiffness(solver), dense = stuck_densely(solver);
      for (int r = 0; r < 2; ++r)
        for (int c = 0; c < 2; ++c) EXPECT_NEAR(s(r, c), dense(r, c), 1e-7 * dense(1, 1)) << width;
      if (kinematics == RingKinematics::exact) {
        EXPECT_GE(s(1, 1), (force - before) / 1e-6 * (1.0 - 1e-4)) << width;  // than where it slides
      }
      EXPECT_GT(s(0, 0), 0.0);
    }
}

TEST(RingSolver, the_moment_on_the_rim_is_what_turning_the_belt_costs) {
  const RingParams p = truck_ring(240);
  RingSolver solver(p, RingGround::bar(0.05, 0.08));
  pressed(solver, 0.04, 4);
  const RingMechanics& ring = solver.ring();
  RingField turn = ring.zero();  // about −y
  for (double& v : turn.v) v = ring.radius();
  const double step = 1e-5;  // rad
  const double slope =
      (ring.energy(along(solver.state(), turn, step)) - ring.energy(along(solver.state(), turn, -step))) / (2.0 * step);
  EXPECT_GT(std::abs(slope), 0.1);
  EXPECT_NEAR(ring.spindle_moment(solver.state()), -slope, 1e-6 * std::abs(slope));
}

TEST(RingSolver, a_stiff_belt_moves_as_a_rigid_ring_that_can_grow) {
  RingParams p = linear_ring(120);
  p.bending = p.shear = 1e9;
  RingSolver solver(p, plate(p));
  const double air = p.ambient * std::pow(2.0 * pi * solver.ring().radius() * p.width, 2) / solver.ring().volume();
  const double expected = 1e-5 / (1.0 / (pi * (p.sidewall_1 + p.tangential)) + 1.0 / (2.0 * pi * p.sidewall_1 + air));
  EXPECT_NEAR(pressed(solver, 1e-5, 1), expected, 1e-3 * expected);
}

/// Without a belt, and with enough air for constant pressure, segments are independent.
RingParams separate_segments(int n) {
  RingParams p = linear_ring(n);
  p.bending = p.shear = 0.0;
  p.air_share = 1e12;
  return p;
}

TEST(RingSolver, separate_segments_on_a_plate_carry_what_each_carries_alone) {
  const RingParams p = separate_segments(480);
  RingSolver solver(p, plate(p));
  const double d = p.radius - 0.06, phi = 2.0 * pi / p.segments;
  double expected = 0.0;
  for (int j = -200; j <= 200; ++j) {
    const double s = std::sin(j * phi), c = std::cos(j * phi);
    if (c > 0.1 && p.radius * c > d)
      expected += phi * (p.radius * c - d) / (c * c / p.sidewall_1 + s * s / p.tangential);
  }
  EXPECT_NEAR(pressed(solver, 0.06, 3), expected, 1e-8 * expected);
}

TEST(RingSolver, separate_radial_segments_on_a_plate_converge_to_their_integral) {
  double error[2];
  for (const int k : {0, 1}) {
    RingParams p = separate_segments(k == 0 ? 240 : 1920);
    p.kinematics = RingKinematics::radial;
    RingSolver solver(p, plate(p));
    const double d = p.radius - 0.06, alpha = std::acos(d / p.radius);
    const double expected = 2.0 * p.sidewall_1 * (p.radius * std::sin(alpha) - d * alpha);
    error[k] = std::abs(pressed(solver, 0.06, 3) / expected - 1.0);
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_LT(error[1], 1e-5);
}

TEST(RingSolver, contact_pushes_where_it_is_closed_and_nowhere_else) {
  for (const RingKinematics kinematics : {RingKinematics::exact, RingKinematics::radial})
    for (const double width : {0.0, 0.025, 0.051, 0.1}) {
      RingParams p = with_tension(truck_ring(240), width == 0.051 ? 0.5 : 0.0);
      p.kinematics = kinematics;
      RingSolver solver(p, width > 0.0 ? RingGround::bar(width, 0.004) : plate(p));
      for (int k = 1; k <= 10; ++k) {
        pressed(solver, 0.01 * k, 1);
        const ContactSet& set = solver.contacts();
        double moment = 0.0;  // Σ λ g
        for (int j = 0; j < 240; ++j) {
          EXPECT_GE(solver.segment_gaps()[j].gap, -1e-12);
          EXPECT_GE(set.segment_force[j] * (set.segment[j] ? 1.0 : 0.0), -1e-5);
          if (set.segment[j]) moment += std::abs(set.segment_force[j] * solver.segment_gaps()[j].gap);
        }
        for (std::size_t c = 0; c < set.corner.size(); ++c) {
          EXPECT_GE(solver.corner_gaps()[c].gap, -1e-12);
          EXPECT_GE(set.corner_force[c], -1e-5);
          moment += std::abs(set.corner_force[c] * solver.corner_gaps()[c].gap);
        }
        EXPECT_LT(moment, 1e-7);
        EXPECT_NEAR(solver.ground_force().z, solver.spindle_force().z, 1e-8 * solver.spindle_force().z);
        EXPECT_NEAR(solver.ground_force().x, solver.spindle_force().x, 1e-8 * solver.spindle_force().z);
      }
    }
}

TEST(RingSolver, force_times_way_is_the_energy_with_exact_kinematics) {
  for (const double width : {0.0, 0.0251, 0.076}) {
    const RingParams p = with_tension(truck_ring(240), width == 0.0251 ? 0.0 : 0.6);
    RingSolver solver(p, width > 0.0 ? RingGround::bar(width, 0.0) : plate(p));
    const double from = 0.05, way = 1e-4;
    pressed(solver, from, 5);
    const double before = solver.ring().energy(solver.state());
    const double work = way * gauss_mean([&](double share) { return pressed(solver, from + share * way, 1); });
    pressed(solver, from + way, 1);
    const double after = solver.ring().energy(solver.state());
    EXPECT_NEAR(after - before, work, 1e-5 * work) << width;
  }
}

TEST(RingSolver, with_a_settled_contact_set_the_steps_converge_quadratically) {
  for (const double tension : {0.0, 0.5})
    for (const double width : {0.0251, 0.038}) {
      const RingParams p = with_tension(truck_ring(120), tension);
      RingSolver solver(p, RingGround::bar(width, 0.0));
      pressed(solver, 0.06, 6);
      const RingReport report = solver.solve({0.0, solver.ring().radius() - 0.1});
      ASSERT_TRUE(report.converged);
      int seen = 0;
      for (int k = 1; k < report.steps; ++k) {
        if (!report.same_set[k] || report.residuals[k] < 1e-3) continue;
        ++seen;  // residuals in N; the bound holds for a first step of 1 N
        EXPECT_LT(report.residuals[k + 1], 2e-4 * report.residuals[k] * report.residuals[k] + 1e-6)
            << k << ": " << report.residuals[k] << " to " << report.residuals[k + 1];
      }
      EXPECT_GE(seen, 2);
      EXPECT_LE(report.steps, 8);
    }
}

TEST(RingSolver, forces_are_consistent_from_120_to_1920_segments) {
  for (const double width : {0.0, 0.0251, 0.051, 0.1}) {
    for (const double tension : {0.0, 0.5}) {
      std::vector<double> force;
      for (const int n : {120, 240, 480, 960, 1920}) {
        const RingParams p = with_tension(truck_ring(n), tension);
        RingSolver solver(p, width > 0.0 ? RingGround::bar(width, 0.0) : plate(p));
        force.push_back(pressed(solver, 0.08, tension > 0.0 ? 16 : 4));  // a taut belt peels off segment by segment
      }
      EXPECT_NEAR(force[0] / force[4], 1.0, 1e-2) << width;
      EXPECT_NEAR(force[2] / force[4], 1.0, 1e-3) << width;
      EXPECT_NEAR(force[3] / force[4], 1.0, 3e-4) << width;
    }
  }
}

TEST(RingSolver, a_plate_stiffens_and_a_cleat_softens) {
  const RingParams p = truck_ring();
  RingSolver on_plate(p, plate(p)), on_cleat(p, RingGround::bar(0.025, 0.0));
  double plate_slope = 0.0, cleat_slope = 1e9, plate_before = 0.0, cleat_before = 0.0;
  for (int k = 1; k <= 4; ++k) {
    const double plate_now = pressed(on_plate, 0.02 * k, 4), cleat_now = pressed(on_cleat, 0.02 * k, 4);
    EXPECT_GT(plate_now - plate_before, 0.98 * plate_slope);
    EXPECT_LT(cleat_now - cleat_before, cleat_slope);
    plate_slope = plate_now - plate_before, cleat_slope = cleat_now - cleat_before;
    plate_before = plate_now, cleat_before = cleat_now;
  }
}

double patch_length(const RingSolver& solver) {
  double low = 0.0, high = 0.0;
  for (int j = 0; j < solver.ring().segments(); ++j)
    if (solver.contacts().segment[j]) {
      const double x = solver.contact().position(solver.state(), j).x;
      low = std::min(low, x), high = std::max(high, x);
    }
  return high - low;
}

TEST(RingSolver, leaving_the_tangential_movement_out_lengthens_the_patch) {
  RingParams p = truck_ring(1920);
  RingSolver exact(p, plate(p));
  pressed(exact, 0.06, 4);
  p.kinematics = RingKinematics::radial;
  RingSolver radial(p, plate(p));
  pressed(radial, 0.06, 4);
  EXPECT_GT(patch_length(radial), 1.01 * patch_length(exact));
}

TEST(RingSolver, where_on_the_ground_the_axle_stands_makes_no_difference) {
  const RingParams p = truck_ring();
  RingSolver here(p, RingGround::bar(0.05, 0.0)), there(p, RingGround::bar(0.05, 12.5));
  EXPECT_NEAR(pressed(here, 0.05, 2), pressed(there, 0.05, 2, 12.5), 1e-7);
  RingSolver left(p, RingGround::bar(0.05, -0.07)), right(p, RingGround::bar(0.05, 0.07));
  EXPECT_NEAR(pressed(left, 0.05, 2), pressed(right, 0.05, 2), 1e-6);
  EXPECT_NEAR(left.spindle_force().x, -right.spindle_force().x, 1e-6);
  EXPECT_GT(left.spindle_force().x, 100.0) << "a bar behind the axle pushes forward";
}

TEST(RingSolver, says_when_the_ground_has_too_many_corners) {
  std::vector<GroundPoint> points;  // an arch of 0.5 mm steps
  for (int k = -400; k <= 400; ++k) points.push_back({5e-4 * k, -1e-7 * k * k});
  const RingParams p = truck_ring(120);
  RingSolver solver(p, RingGround(points));
  const RingReport report = solver.solve({0.0, p.radius - 0.03});
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.crowded);
}

TEST(RingSolver, rolls_over_any_profile) {
  // A kerb with a slope, a ditch, a row of sharp ridges.
  std::vector<GroundPoint> points{{-2.0, 0.0},   {0.0, 0.0},   {0.02, 0.06}, {0.6, 0.06},
                                  {0.65, -0.05}, {0.8, -0.05}, {0.85, 0.0}};
  for (int k = 0; k < 12; ++k) points.push_back({0.9 + 0.05 * k, k % 2 == 0 ? 0.0 : 0.02});
  points.push_back({1.5, 0.0}), points.push_back({3.0, 0.0});
  for (const RingKinematics kinematics : {RingKinematics::exact, RingKinematics::radial}) {
    RingParams p = truck_ring(160);
    p.kinematics = kinematics;
    RingSolver solver(p, RingGround(points));
    double most = 0.0;
    for (int k = 0; k <= 250; ++k) {
      const RingReport report = solver.solve({-0.5 + 0.01 * k, solver.ring().radius() - 0.02});
      ASSERT_TRUE(report.converged) << "at x = " << -0.5 + 0.01 * k << " m: residual " << report.residual
                                    << ", penetration " << report.penetration << ", pull " << report.pull;
      most = std::max(most, solver.spindle_force().z);
      EXPECT_GE(solver.spindle_force().z, 0.0);
    }
    EXPECT_GT(most, 20e3);
    EXPECT_NEAR(solver.spindle_force().x, 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace furrow::tire
