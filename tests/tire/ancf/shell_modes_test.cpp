// Natural frequencies of a shell between two rings against closed forms of a cylinder.
#include "tire/ancf/shell_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/small_tire.hpp"

namespace furrow::test {
namespace {

constexpr double kRadius = 0.4, kLength = 0.3, kThickness = 2e-3;  // m
constexpr double kModulus = 1e7, kShear = 4e6, kDensity = 1000.0;  // Pa, kg/m³

/// An isotropic tube of one layer instead of the tire, without pressure.
tire::TireFile tube(int columns, int width) {
  tire::TireFile file = small_file("hmmwv_lumped.json", columns, width);
  file.rim_radius = file.radius = kRadius, file.rim_width = kLength;
  file.pressure = 0.0;
  file.profile.clear();
  for (int k = 0; k <= 8; ++k) file.profile.push_back({k / 8.0, 0.0, kLength * (k / 8.0 - 0.5)});
  const double poisson = kModulus / (2.0 * kShear) - 1.0;
  file.materials = {{"tube", kDensity, Vec3::Constant(kModulus), Vec3::Constant(poisson), Vec3::Constant(kShear)}};
  for (tire::Section* section : {&file.bead, &file.sidewall, &file.tread}) section->layers = {{kThickness, 0.0, 0}};
  return file;
}

TEST(ShellModes, torsion_of_a_held_tube_is_that_of_a_bar) {
  // Order 0, u_θ = sin(mπy/L): f = m/(2L) √(G/ρ), without bending.
  double before = 1.0;
  for (const int width : {12, 24}) {
    const tire::ShellModes test(tube(24, width));
    const tire::ModesResults results = test.modes({.orders = 0, .count = 40}, {});
    double off = 0.0;
    int found = 0;
    for (const tire::Mode& mode : results.modes) {
      double turning = 0.0, others = 0.0;
      for (const auto& node : mode.shape)
        turning = std::max(turning, std::abs(node[0])),
        others = std::max({others, std::abs(node[1]), std::abs(node[2])});
      if (turning < 0.99 || others > 1e-3 || found == 2) continue;
      const double exact = ++found / (2.0 * kLength) * std::sqrt(kShear / kDensity);
      off = std::max(off, std::abs(mode.frequency / exact - 1.0));
    }
    ASSERT_EQ(found, 2) << width;
    EXPECT_LT(off, 0.3 * before) << width;
    before = off;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(ShellModes, results_name_orders_in_turn_and_leave_the_beads_at_rest) {
  const tire::ShellModes test(small_file("hmmwv_lumped.json", 24, 6));
  EXPECT_EQ(test.sections(), 24);
  EXPECT_EQ(test.unknowns(), 30);
  const tire::ModesResults results = test.modes({.orders = 4, .count = 2}, {});
  ASSERT_EQ(results.modes.size(), 10u);
  ASSERT_EQ(results.section.size(), 7u);
  EXPECT_NEAR(results.mass.mass, 11.5, 1.0);
  EXPECT_EQ(results.pressure, 200e3);
  const tire::InflatedCarcass carcass(small_file("hmmwv_lumped.json", 24, 6));
  for (std::size_t k = 0; k < results.modes.size(); ++k) {
    const tire::Mode& mode = results.modes[k];
    EXPECT_EQ(mode.order, static_cast<int>(k / 2));
    EXPECT_NEAR(mode.frequency, carcass.frequencies(mode.order, 2)[k % 2], 1e-9 * mode.frequency);
    for (const std::size_t bead : {0, 6}) EXPECT_EQ(mode.shape[bead][2], 0.0);
  }
}

}  // namespace
}  // namespace furrow::test
