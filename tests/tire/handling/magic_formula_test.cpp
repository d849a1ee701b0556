// The Magic Formula against its limits in closed form [Pacejka 2012, section 4.3.1].
#include "tire/handling/magic_formula.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/tire/handling/example_tire.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kLoads[] = {800.0, 2500.0, 4000.0, 7500.0};

TEST(MagicFormula, slope_at_no_slip_is_the_slip_stiffness) {
  const MagicFormula t = symmetric_tire();
  const double h = 1e-6;
  for (const double load : kLoads) {
    const double df = load / 4000.0 - 1.0;
    const auto& x = t.longitudinal;
    const double kx = load * (x.pkx1 + x.pkx2 * df) * std::exp(x.pkx3 * df);
    const double ky =
        t.lateral.pky1 * 4000.0 * std::sin(2.0 * std::atan(load / (t.lateral.pky2 * 4000.0))) * t.scaling.lky;
    const HandlingForces forward = evaluate(t, {.load = load, .slip = h}),
                         back = evaluate(t, {.load = load, .slip = -h});
    EXPECT_NEAR((forward.fx - back.fx) / (2 * h), kx, 1e-6 * kx);
    EXPECT_DOUBLE_EQ(forward.slip_stiffness, kx);
    const HandlingForces left = evaluate(t, {.load = load, .slip_angle = h}),
                         right = evaluate(t, {.load = load, .slip_angle = -h});
    EXPECT_NEAR((left.fy - right.fy) / (2 * h), ky, -1e-6 * ky);
    EXPECT_NEAR(left.cornering_stiffness, ky, -1e-12 * ky);
    EXPECT_LT(left.fy, 0.0) << "a positive slip angle gives a force to the right (ISO 8855)";
  }
}

/// y reaches D where C atan(Bx − E(Bx − atan Bx)) = π/2, if C > 1.
TEST(MagicFormula, peak_is_d) {
  const MagicFormula t = symmetric_tire();
  for (const double load : kLoads) {
    const double df = load / 4000.0 - 1.0;
    const double dx = load * (t.longitudinal.pdx1 + t.longitudinal.pdx2 * df) * t.scaling.lmux,
                 dy = load * (t.lateral.pdy1 + t.lateral.pdy2 * df) * t.scaling.lmuy;
    double most_x = 0.0, most_y = 0.0;
    for (int k = 0; k < 20000; ++k) {
      most_x = std::max(most_x, evaluate(t, {.load = load, .slip = 1.2 * k / 20000}).fx);
      most_y = std::max(most_y, std::abs(evaluate(t, {.load = load, .slip_angle = 0.6 * k / 20000}).fy));
    }
    EXPECT_NEAR(most_x, dx, 1e-6 * dx);
    EXPECT_NEAR(most_y, dy, 1e-6 * dy);
  }
}

/// At very large slip the sine's argument tends to C π/2 if E < 1.
TEST(MagicFormula, asymptote_is_d_times_the_sine_of_c) {
  MagicFormula t = symmetric_tire();
  const double end =
      t.longitudinal.pdx1 * t.scaling.lmux * 4000.0 * std::sin(0.5 * std::numbers::pi * t.longitudinal.pcx1);
  EXPECT_NEAR(evaluate_formula(t, {.load = 4000.0, .slip = 1e9}).fx, end, 1e-6 * std::abs(end));
}

TEST(MagicFormula, is_odd_in_slip_and_slip_angle_without_shifts) {
  const MagicFormula t = symmetric_tire();
  for (const double load : kLoads)
    for (const double slip : {0.0, 0.02, 0.3})
      for (const double angle : {0.0, 0.03, 0.2}) {
        const HandlingForces a = evaluate(t, {.load = load, .slip = slip, .slip_angle = angle}),
                             b = evaluate(t, {.load = load, .slip = slip, .slip_angle = -angle}),
                             c = evaluate(t, {.load = load, .slip = -slip, .slip_angle = angle});
        EXPECT_NEAR(a.fx, b.fx, 1e-9);
        EXPECT_NEAR(a.fy, -b.fy, 1e-9);
        EXPECT_NEAR(a.mx, -b.mx, 1e-9);
        EXPECT_NEAR(a.fx, -c.fx, 1e-9);
        EXPECT_NEAR(a.fy, c.fy, 1e-9);
        if (angle != 0.0) {  // at 0 the equivalent slip angle has the sign +
          EXPECT_NEAR(a.mz, -b.mz, 1e-9);
        }
      }
}

/// A mirrored wheel: α, γ change their signs, and with them F_y, M_x and M_z, if the formula has no ply steer.
TEST(MagicFormula, camber_and_slip_angle_mirror_together) {
  const MagicFormula t = symmetric_tire();
  for (const double angle : {-0.1, 0.02, 0.2})
    for (const double camber : {-0.08, 0.1}) {
      const HandlingForces a = evaluate(t, {.load = 3000.0, .slip_angle = angle, .camber = camber}),
                           b = evaluate(t, {.load = 3000.0, .slip_angle = -angle, .camber = -camber});
      EXPECT_NEAR(a.fy, -b.fy, 1e-9);
      EXPECT_NEAR(a.mx, -b.mx, 1e-9);
      EXPECT_NEAR(a.mz, -b.mz, 1e-9);
      EXPECT_NEAR(a.fx, b.fx, 1e-9);
    }
  EXPECT_LT(evaluate(t, {.load = 3000.0, .camber = 0.1}).fy, 0.0)
      << "leaning to the right pulls to the right (ISO 8855)";
}

TEST(MagicFormula, combined_slip_without_the_other_slip_is_pure) {
  MagicFormula t = example_tire();
  t.lateral.rvy1 = t.lateral.rvy2 = t.lateral.rvy3 = 0.0;
  MagicFormula pure = t;
  pure.longitudinal.rbx1 = pure.lateral.rby1 = 1e-300;  // no weighting; 0 is the friction ellipse
  for (const double load : kLoads) {
    for (const double slip : {-0.3, -0.02, 0.05, 0.8})
      EXPECT_DOUBLE_EQ(evaluate(t, {.load = load, .slip = slip}).fx, evaluate(pure, {.load = load, .slip = slip}).fx);
    for (const double angle : {-0.2, 0.01, 0.3})
      EXPECT_DOUBLE_EQ(evaluate(t, {.load = load, .slip_angle = angle}).fy,
                       evaluate(pure, {.load = load, .slip_angle = angle}).fy);
  }
  const HandlingForces both = evaluate(symmetric_tire(), {.load = 4000.0, .slip = 0.1, .slip_angle = 0.1}),
                       alone = evaluate(symmetric_tire(), {.load = 4000.0, .slip = 0.1});
  EXPECT_LT(both.fx, 0.95 * alone.fx);
}

/// Forces are within the ellipse of the peaks at any slips. They equal the pure forces if the other slip is zero, and
/// are along the slip if both slide.
TEST(MagicFormula, without_coefficients_of_combined_slip_it_keeps_within_the_friction_ellipse) {
  MagicFormula t = symmetric_tire();
  t.longitudinal.rbx1 = t.lateral.rcy1 = 0.0;
  t.lateral.rvy3 = 0.0;
  MagicFormula pure = t;
  pure.longitudinal.rbx1 = pure.lateral.rby1 = pure.lateral.rcy1 = 1e-300;
  MagicFormula told = symmetric_tire();  // by FE_METHOD, with a friction below 0, as some programs write it
  told.friction_ellipse = true;
  told.lateral.rvy3 = 0.0;
  told.lateral.pdy1 *= -1.0, told.lateral.pdy2 *= -1.0;
  EXPECT_TRUE(ellipse_along(t) && ellipse_across(t) && ellipse_along(told) && ellipse_across(told));
  EXPECT_FALSE(ellipse_along(pure) || ellipse_across(pure));
  for (const double load : kLoads) {
    const double df = load / 4000.0 - 1.0;
    const double dx = load * (t.longitudinal.pdx1 + t.longitudinal.pdx2 * df) * t.scaling.lmux,
                 dy = load * (t.lateral.pdy1 + t.lateral.pdy2 * df) * t.scaling.lmuy;
    double most = 0.0;
    for (const double slip : {-0.9, -0.1, -0.01, 0.0, 1e-4, 0.05, 0.2, 1.2})
      for (const double angle : {-0.5, -0.1, 0.0, 1e-3, 0.05, 0.3}) {
        const HandlingForces f = evaluate(t, {.load = load, .slip = slip, .slip_angle = angle}),
                             x = evaluate(pure, {.load = load, .slip = slip}),
                             y = evaluate(pure, {.load = load, .slip_angle = angle});
        EXPECT_DOUBLE_EQ(evaluate(told, {.load = load, .slip = slip, .slip_angle = angle}).fx, f.fx);
        EXPECT_DOUBLE_EQ(evaluate(told, {.load = load, .slip = slip, .slip_angle = angle}).fy, f.fy);
        const double share = std::hypot(f.fx / dx, f.fy / dy);
        EXPECT_LE(share, 1.0 + 1e-12) << slip << " " << angle;
        most = std::max(most, share);
        if (angle == 0.0) {
          EXPECT_DOUBLE_EQ(f.fx, x.fx);
        }
        if (slip == 0.0) {
          EXPECT_DOUBLE_EQ(f.fy, y.fy);
        }
        EXPECT_LE(std::abs(f.fx), std::abs(x.fx) * (1.0 + 1e-12));
        EXPECT_LE(std::abs(f.fy), std::abs(y.fy) * (1.0 + 1e-12));
      }
    EXPECT_GT(most, 0.9);
    // The slopes at zero slip do not change: neither small slip weakens the other's force.
    const HandlingForces small = evaluate(t, {.load = load, .slip = 1e-5, .slip_angle = 1e-5}),
                         alone = evaluate(pure, {.load = load, .slip = 1e-5, .slip_angle = 1e-5});
    EXPECT_NEAR(small.fx, alone.fx, 1e-6 * std::abs(alone.fx));
    EXPECT_NEAR(small.fy, alone.fy, 1e-6 * std::abs(alone.fy));
  }
}

/// Without pressure change and camber, 6.1 equals 5.2 if the curve of K_yα is that of an atan of 2.
TEST(MagicFormula, version_6_1_without_its_terms_is_5_2) {
  MagicFormula old = example_tire();
  old.lateral.phy3 = 0.0;
  MagicFormula later = old;
  later.version61 = true;
  later.rolling.qsy7 = 1.0;
  later.conditions = {.inflpres = 2e5, .nompres = 2e5};
  for (const double load : kLoads)
    for (const double slip : {-0.3, 0.0, 0.05})
      for (const double angle : {-0.2, 0.0, 0.03}) {
        const SlipState at{.load = load, .slip = slip, .slip_angle = angle, .speed = 9.0};
        const HandlingForces a = evaluate(old, at), b = evaluate(later, at);
        for (const auto part :
             {&HandlingForces::fx, &HandlingForces::fy, &HandlingForces::mx, &HandlingForces::my, &HandlingForces::mz})
          EXPECT_NEAR(a.*part, b.*part, 1e-9);
      }
}

/// K and the peaks contain the terms of pressure in closed form, and dF_y/dγ at zero slip is K_yγ0 (4.E30).
TEST(MagicFormula, version_6_1_depends_on_pressure_and_camber_as_its_equations_say) {
  MagicFormula t = later_tire();
  const double dpi = 0.2, df = -0.25, load = 3000.0;
  EXPECT_NEAR(pressure_change(t), dpi, 1e-15);
  const HandlingForces f = evaluate(t, {.load = load});
  const auto& x = t.longitudinal;
  EXPECT_NEAR(f.slip_stiffness,
              load * (x.pkx1 + x.pkx2 * df) * std::exp(x.pkx3 * df) * (1.0 - 0.35 * dpi + 0.4 * dpi * dpi), 1e-8);
  EXPECT_NEAR(f.cornering_stiffness,
              -18.0 * 4000.0 * (1.0 - 0.6 * dpi) * std::sin(1.8 * std::atan(0.75 / (1.9 * (1.0 - 0.05 * dpi)))) * 1.05,
              1e-8);
  auto& y = t.lateral;  // no shifts, no lifts: the slope at no slip is that of E = 0 too
  y.phy1 = y.phy2 = y.pvy1 = y.pvy2 = y.rvy1 = y.rvy2 = y.rvy3 = 0.0;
  const double h = 1e-5;
  const double slope =
      (evaluate(t, {.load = load, .camber = h}).fy - evaluate(t, {.load = load, .camber = -h}).fy) / (2.0 * h);
  EXPECT_NEAR(slope, load * (-0.9 - 0.25 * df) * (1.0 - 0.3 * dpi) * 1.1 * t.scaling.lgay, 1e-3);
}

/// Values of the Magic Formula Tyre Library, https://github.com/teasit/magic-formula-tyre-library, package
/// magicformula.v61, run with Octave. It has α for tan α in F_y, and M_z without the camber of S_Hy and S_Vy.
TEST(MagicFormula, version_6_1_gives_what_another_program_gives) {
  MagicFormula t = later_tire();
  t.scaling.lmux = t.scaling.lmuy = t.scaling.lgay = 1.0;
  struct Value {
    double load, slip, angle, camber, fx, fy, mz;
  };
  for (const Value& v : {Value{3000.0, 0.05, 0.02, 0.0, 2273.478648, -784.4771345, 27.12129468},
                         {5000.0, -0.1, 0.05, 0.0, -4470.801767, -1951.309439, -28.1960481},
                         {4000.0, 0.02, -0.08, 0.0, 1225.066468, 3032.345397, -58.58218942},
                         {3000.0, 0.05, 0.02, 0.05, 2272.151409, -844.0465422, 0.0},
                         {5000.0, -0.1, 0.05, -0.1, -4447.022818, -1457.79543, 0.0},
                         {4000.0, 0.02, -0.08, 0.1, 1221.867462, 2760.447399, 0.0}}) {
    const HandlingForces f =
        evaluate(t, {.load = v.load, .slip = v.slip, .slip_angle = v.angle, .camber = v.camber, .speed = 10.0});
    EXPECT_NEAR(f.fx, v.fx, 1e-8 * std::abs(v.fx)) << v.load;
    EXPECT_NEAR(f.fy, v.fy, 2e-3 * std::abs(v.fy)) << v.load;
    if (v.camber == 0.0) {
      EXPECT_NEAR(f.mz, v.mz, 2e-3 * std::abs(v.mz)) << v.load;
    }
  }
}

TEST(MagicFormula, relaxation_of_6_1_is_slip_stiffness_over_that_of_the_carcass) {
  const MagicFormula t = later_tire();
  const HandlingForces f = evaluate(t, {.load = 4000.0});
  EXPECT_NEAR(relaxation_lengths(t, 4000.0, 0.0).longitudinal, f.slip_stiffness / (3.2e5 * 1.06), 1e-12);
  EXPECT_NEAR(relaxation_lengths(t, 4000.0, 0.0).lateral, -f.cornering_stiffness / (1.4e5 * 1.05), 1e-12);
  EXPECT_EQ(relaxation_lengths(t, 0.0, 0.0).longitudinal, 0.0);
}

/// The spring passes through its points and has the energy of its area; force and deflection are inverse functions; C_z
/// under the nominal load of 6.1.
TEST(MagicFormula, spring_follows_the_curve_of_the_file) {
  MagicFormula t = example_tire();
  EXPECT_EQ(spring_force(t, 0.01), 2200.0);
  EXPECT_EQ(spring_stiffness(t, 4000.0), 2.2e5);
  t.load_curve = {{0.0, 0.0}, {0.01, 1500.0}, {0.02, 4000.0}, {0.04, 10000.0}};
  for (const auto& [deflection, load] : t.load_curve) EXPECT_DOUBLE_EQ(spring_force(t, deflection), load);
  EXPECT_DOUBLE_EQ(spring_force(t, 0.015), 2750.0);
  EXPECT_DOUBLE_EQ(spring_force(t, 0.05), 13000.0) << "beyond it by its last slope";
  EXPECT_EQ(spring_force(t, -0.01), 0.0);
  EXPECT_NEAR(spring_energy(t, 0.05), 7.5 + 27.5 + 140.0 + 115.0, 1e-10);
  EXPECT_NEAR(spring_stiffness(t, 3000.0), 2.5e5, 1e-6);
  for (MagicFormula u : {t, later_tire()}) {
    double sum = 0.0;
    const int pieces = 2000;
    for (int k = 0; k < pieces; ++k) sum += spring_force(u, 0.04 * (k + 0.5) / pieces) * 0.04 / pieces;
    EXPECT_NEAR(spring_energy(u, 0.04), sum, 1e-4);
    for (const double load : {0.0, 700.0, 3999.0, 12000.0})
      EXPECT_NEAR(spring_force(u, spring_deflection(u, load)), load, 1e-9);
  }
  MagicFormula later = later_tire();
  later.conditions = {};
  EXPECT_NEAR(spring_stiffness(later, 4000.0), 2.2e5, 1e-6);
}

/// −M_z/F_y → the trail D_t for small angles, and M_z = −t F_y without residual moment and arm.
TEST(MagicFormula, trail_at_no_slip_is_d_t) {
  MagicFormula t = symmetric_tire();
  const HandlingForces f = evaluate(t, {.load = 4000.0, .slip_angle = 1e-6});
  EXPECT_NEAR(-f.mz / f.fy, t.aligning.qdz1 * 0.35 * t.scaling.ltr, 1e-8);
}

TEST(MagicFormula, rolling_resistance_opposes_forward_rolling) {
  MagicFormula t = symmetric_tire();
  t.rolling = {.qsy1 = 0.01};
  EXPECT_NEAR(evaluate(t, {.load = 4000.0, .speed = 10.0}).my, -0.01 * 4000.0 * 0.35, 1e-12);
}

TEST(MagicFormula, holds_the_ends_of_its_ranges_and_scales_with_loads_beyond_them) {
  const MagicFormula t = example_tire();
  EXPECT_EQ(evaluate(t, {.load = 4000.0, .slip = 1.2}).fx, evaluate(t, {.load = 4000.0, .slip = 7.0}).fx);
  EXPECT_EQ(evaluate(t, {.load = 4000.0, .slip_angle = -0.6}).mz, evaluate(t, {.load = 4000.0, .slip_angle = -1.5}).mz);
  EXPECT_NEAR(evaluate(t, {.load = 18000.0, .slip = 0.1}).fx, 2.0 * evaluate(t, {.load = 9000.0, .slip = 0.1}).fx,
              1e-9);
  EXPECT_NEAR(evaluate(t, {.load = 1.0, .slip = 0.1}).fx, evaluate(t, {.load = 200.0, .slip = 0.1}).fx / 200.0, 1e-12);
  EXPECT_EQ(evaluate(t, {.load = 0.0, .slip = 0.1}).fx, 0.0);
  EXPECT_EQ(evaluate(t, {.load = 18000.0}).fz, 18000.0);
}

/// For every load the peaks are reduced in the ratio of the frictions; the slope at zero slip is not.
TEST(MagicFormula, on_a_smoother_ground_its_peaks_are_the_ground_s_and_its_stiffnesses_its_own) {
  const MagicFormula t = symmetric_tire();
  const auto peaks = [](const MagicFormula& tire, double load) {
    std::pair<double, double> most;
    for (int i = 0; i <= 1200; ++i) {
      most.first = std::max(most.first, evaluate(tire, {.load = load, .slip = 1e-3 * i}).fx);
      most.second = std::max(most.second, evaluate(tire, {.load = load, .slip_angle = -5e-4 * i}).fy);
    }
    return most;
  };
  for (const double ground : {0.5, 0.2, 0.05}) {
    const MagicFormula smooth = on_ground_of(t, ground);
    EXPECT_NEAR(peaks(smooth, 4000.0).first, ground * 4000.0, 1e-4 * 4000.0);
    EXPECT_NEAR(peaks(smooth, 4000.0).second, ground * 4000.0, 1e-4 * 4000.0);
    const HandlingForces a = evaluate(t, {.load = 2500.0}), b = evaluate(smooth, {.load = 2500.0});
    EXPECT_EQ(a.slip_stiffness, b.slip_stiffness);
    EXPECT_EQ(a.cornering_stiffness, b.cornering_stiffness);
    EXPECT_NEAR(peaks(smooth, 2500.0).first / peaks(t, 2500.0).first, ground / (t.scaling.lmux * t.longitudinal.pdx1),
                1e-3);
  }
  const MagicFormula rough = on_ground_of(t, 2.0);
  EXPECT_EQ(rough.scaling.lmux, t.scaling.lmux);
  EXPECT_EQ(rough.scaling.lmuy, t.scaling.lmuy);
  // With a friction between its two peaks, only the higher one is reduced.
  const double between = 0.5 * (t.scaling.lmux * t.longitudinal.pdx1 + t.scaling.lmuy * t.lateral.pdy1);
  EXPECT_LT(on_ground_of(t, between).scaling.lmux, t.scaling.lmux);
  EXPECT_EQ(on_ground_of(t, between).scaling.lmuy, t.scaling.lmuy);
  const HandlingForces ice =
      evaluate(on_ground_of(example_tire(), 0.0), {.load = 4000.0, .slip = 0.3, .slip_angle = 0.1});
  EXPECT_TRUE(std::isfinite(ice.fx + ice.fy + ice.mz));
  EXPECT_LT(std::hypot(ice.fx, ice.fy), 0.1);
}

TEST(MagicFormula, rolling_radius_is_that_of_the_wheel_in_the_air_and_falls_with_the_load) {
  const MagicFormula t = example_tire();
  EXPECT_EQ(rolling_radius(t, 0.0), 0.35);
  const double nominal = 4000.0 / 2.2e5;
  EXPECT_NEAR(rolling_radius(t, nominal), 0.35 - nominal * (0.25 * std::atan(8.0) + 0.05), 1e-15);
}

TEST(MagicFormula, relaxation_lengths_at_the_nominal_load) {
  const MagicFormula t = example_tire();
  const RelaxationLengths s = relaxation_lengths(t, 4000.0, 0.0);
  EXPECT_NEAR(s.longitudinal, 0.4 * 0.35, 1e-15);
  EXPECT_NEAR(s.lateral, 1.3 * std::sin(2.0 * std::atan(1.0 / 1.7)) * 0.35, 1e-15);
  EXPECT_EQ(relaxation_lengths(t, 0.0, 0.0).longitudinal, 0.0);
}

}  // namespace
}  // namespace furrow::tire::handling
