// Regressions of traction against numbers computed by hand from their formulas. All use one wheel: d 1 m, b 0.3 m, h
// 0.2 m, δ 0.04 m, W 3 kN on soil with a cone index of 200 kPa, so C_n = 20, b/d = 0.3, δ/h = 0.2; at slip 0.2.
#include <gtest/gtest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "nodes/output/regressions.hpp"

namespace furrow {
namespace {

using output::SoilWheel;
using output::Traction;

constexpr SoilWheel kWheel{.cone_index = 200e3,
                           .diameter = 1.0,
                           .width = 0.3,
                           .section_height = 0.2,
                           .deflection = 0.04,
                           .load = 3000.0,
                           .slip = 0.2};

void expect_ratios(const Traction& found, double gross, double resistance, double tolerance = 1e-5) {
  EXPECT_NEAR(found.gross / kWheel.load, gross, tolerance);
  EXPECT_NEAR(found.resistance / kWheel.load, resistance, tolerance);
  EXPECT_DOUBLE_EQ(found.net, found.gross - found.resistance);
}

TEST(Regressions, bias_ply_tires_match_brixius_1987) {
  // B_n = 20 · 2/1.9 = 21.0526; 0.88 (1 − e^−2.10526)(1 − e^−1.5) + 0.04 = 0.88 · 0.878186 · 0.776870 + 0.04
  // 1/21.0526 + 0.04 + 0.1/4.588315
  expect_ratios(output::brixius_bias(kWheel), 0.640368, 0.109294);
}

TEST(Regressions, radial_tires_match_al_hamed_1994) {
  // 0.88 · 0.878186 · (1 − e^−1.9 = 0.850431) + 0.0325;  0.9/21.0526 + 0.0325 + 0.1/4.588315
  expect_ratios(output::brixius_radial(kWheel), 0.689717, 0.097044);
}

TEST(Regressions, loam_matches_wismer_and_luth_1973) {
  // 0.75 (1 − e^−1.2 = 0.698806);  1.2/20 + 0.04
  expect_ratios(output::wismer_luth(kWheel), 0.524104, 0.1);
}

TEST(Regressions, sand_matches_turnage_1972) {
  // G = 200e3/(3.47 · 0.0254) = 2.26916e6 Pa/m; N_s = 2.26916e6 · 0.164317/3000 · 0.2 = 24.8575
  // Y = 4.71 + 8.6 = 13.31; 0.66 · 34.8575/48.1675;  0.53 − 4.5/28.5575
  const Traction found = output::wes_sand(kWheel);
  EXPECT_NEAR(found.gross / kWheel.load, 0.477624, 1e-5);
  EXPECT_TRUE(std::isnan(found.resistance));
  EXPECT_NEAR(found.net / kWheel.load, 0.372423, 1e-5);
}

TEST(Regressions, sand_matches_mason_2018_and_williams_2019) {
  // a = 0.066, √(0.066 − 0.004356) = 0.248282; 1.5^0.52 = 1.234709; CP = 3000/(0.6 · 0.248282 · 1.234709) = 16310.1 Pa
  // r = 0.0815506: T = 0.530361, A = 0.931673, C = 1.290229
  // −0.5 + 1.030361/(1 + 0.931673 · 0.246597)^0.775056;  0.4 r + 0.12 − 0.03
  expect_ratios(output::mason_sand(kWheel), 0.377762, 0.122620);
}

TEST(Regressions, a_towed_wheel_has_the_resistance_of_towed_wheels) {
  SoilWheel towed = kWheel;
  towed.slip = -0.1;
  expect_ratios(output::mason_sand(towed), output::mason_sand(towed).gross / kWheel.load, 0.21 * 0.0815506 + 0.115);
  EXPECT_TRUE(std::isnan(output::brixius_bias(towed).gross));
  EXPECT_TRUE(std::isnan(output::wes_sand(towed).net));
}

TEST(Regressions, the_rolling_radii_of_a_rigid_wheel_are_its_radius) {
  EXPECT_DOUBLE_EQ(output::free_rolling_radius(0.5, 0.0), 0.5);
  EXPECT_DOUBLE_EQ(output::no_pull_radius(0.5, 0.0), 0.5);
  // 2.5 · 0.5 · 0.46/(0.75 + 0.46) [Brixius 1987]
  EXPECT_NEAR(output::no_pull_radius(0.5, 0.04), 0.475207, 1e-6);
  EXPECT_NEAR(output::free_rolling_radius(0.5, 0.04), 0.486667, 1e-6);
}

TEST(Regressions, the_sand_numeric_of_a_rigid_wheel_gives_nothing) {
  SoilWheel rigid = kWheel;
  rigid.deflection = 0.0;
  EXPECT_TRUE(std::isnan(output::wes_sand(rigid).gross));
  rigid.section_height = NAN;  // a wheel without a rim
  EXPECT_TRUE(std::isfinite(output::brixius_bias(rigid).net));
  EXPECT_TRUE(std::isnan(output::mason_sand(rigid).net));
}

TEST(Regressions, what_needs_an_unknown_section_height_is_null) {
  SoilWheel wheel = kWheel;
  wheel.section_height = NAN;
  const auto json = output::regressions_json(wheel, {0.2, 0.2}, false);
  for (const char* name : {"brixius_bias", "brixius_radial", "wes_sand", "mason"}) {
    EXPECT_TRUE(json[name]["net_N"].is_null()) << name;
    EXPECT_FALSE(json[name]["in_range"].get<bool>()) << name;
  }
  EXPECT_NEAR(json["wismer_luth"]["net_N"].get<double>(), 1272.31, 0.01);
}

TEST(Regressions, of_loam_do_not_hold_on_sand_nor_those_of_sand_on_loam) {
  const auto in_range = [](bool cohesive, const char* name) {
    return output::regressions_json(kWheel, {0.2, 0.2}, cohesive)[name]["in_range"].get<bool>();
  };
  for (const char* name : {"wes_sand", "mason"}) {
    EXPECT_TRUE(in_range(false, name)) << name;
    EXPECT_FALSE(in_range(true, name)) << name;
  }
  for (const char* name : {"brixius_bias", "brixius_radial", "wismer_luth"})
    EXPECT_FALSE(in_range(false, name)) << name;
  EXPECT_TRUE(in_range(true, "wismer_luth"));
  EXPECT_FALSE(in_range(true, "brixius_bias"));  // 10 kN/m²
}

TEST(Regressions, are_null_without_a_cone_index) {
  SoilWheel wheel = kWheel;
  wheel.cone_index = NAN;
  EXPECT_TRUE(output::regressions_json(wheel, {0.2, 0.2}, false).is_null());
}

}  // namespace
}  // namespace furrow
