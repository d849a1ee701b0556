// Reference: ruts of known depth and width pressed into height fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "nodes/output/statistics.hpp"
#include "terrain/rut.hpp"

namespace furrow {
namespace {

constexpr double kTread = 0.24, kDepth = 0.02, kRadius = 0.4673;  // m

HeightField flat(double length, double cell) {
  HeightField field;
  field.cell = cell;
  field.nx = static_cast<std::int32_t>(length / cell);
  field.ny = static_cast<std::int32_t>(0.6 / cell);
  field.x0 = 0.5 * cell;
  field.y0 = -0.3 + 0.5 * cell;
  field.height.assign(static_cast<std::size_t>(field.nx) * field.ny, 0.1);
  return field;
}

/// A trapezoidal rut from x = a to b: `kDepth` deep, kTread wide at half its depth, with sides 20 mm wide, between
/// heaps 5 mm high.
HeightField pressed(HeightField field, double a, double b, double noise = 0.0) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> random(-noise, noise);
  for (int ix = 0; ix < field.nx; ++ix)
    for (int iy = 0; iy < field.ny; ++iy) {
      const double x = field.x0 + ix * field.cell, y = std::abs(field.y0 + iy * field.cell);
      if (x < a || x > b) continue;
      const double side = std::clamp(0.5 + (0.5 * kTread - y) / 0.02, 0.0, 1.0);
      const double heap = y > 0.5 * kTread + 0.01 && y < 0.5 * kTread + 0.05 ? 0.005 : 0.0;
      field.height[ix * field.ny + iy] += heap - kDepth * side + random(engine);
    }
  return field;
}

terrain::RutOptions forward() {
  return {.axle = 2.0, .start = 0.5, .lateral = 0.0, .direction = 1.0, .radius = kRadius, .tread_width = kTread};
}

TEST(Rut, depth_and_width_of_a_pressed_trapezoid) {
  for (const double cell : {0.012, 0.02}) {
    const HeightField before = flat(2.65, cell);
    const terrain::Rut rut = terrain::measure_rut(before, pressed(before, 0.5, 2.0), forward());
    ASSERT_TRUE(rut.measured);
    EXPECT_NEAR(rut.depth, kDepth, 1e-12) << "cell " << cell;
    EXPECT_NEAR(rut.width, kTread, 0.25 * cell) << "cell " << cell;
  }
}

TEST(Rut, rough_grains_change_depth_and_width_little) {
  const HeightField before = flat(2.65, 0.02);
  const terrain::Rut rut = terrain::measure_rut(before, pressed(before, 0.5, 2.0, 0.01), forward());
  EXPECT_NEAR(rut.depth, kDepth, 0.001);
  EXPECT_NEAR(rut.width, kTread, 0.05 * kTread);
}

TEST(Rut, travel_backwards_measures_on_the_other_side_of_the_axle) {
  const HeightField before = flat(2.65, 0.02);
  const HeightField after = pressed(before, 0.6, 2.1);
  terrain::RutOptions options = forward();
  options.direction = -1.0;
  options.axle = 0.6;
  options.start = 2.1;
  const terrain::Rut rut = terrain::measure_rut(before, after, options);
  ASSERT_TRUE(rut.measured);
  EXPECT_NEAR(rut.depth, kDepth, 1e-12);
}

TEST(Rut, one_raised_row_of_cells_inside_the_rut_is_not_its_edge) {
  const HeightField before = flat(2.65, 0.02);
  HeightField after = pressed(before, 0.5, 2.0);
  for (int ix = 0; ix < after.nx; ++ix) after.height[ix * after.ny + after.ny / 2 + 3] = 0.1;
  const terrain::Rut rut = terrain::measure_rut(before, after, forward());
  EXPECT_NEAR(rut.width, kTread, 0.02);
}

/// The error of its depth follows from these rows, the waves of one bed along the track.
TEST(Rut, depth_is_the_mean_of_the_rows_along_the_track) {
  const HeightField before = flat(2.65, 0.02);
  const terrain::Rut rut = terrain::measure_rut(before, pressed(before, 0.5, 2.0, 0.01), forward());
  ASSERT_EQ(rut.along.size(), 13u);  // 0.25 m
  double sum = 0.0;
  for (const double depth : rut.along) sum += depth;
  EXPECT_NEAR(sum / 13.0, rut.depth, 1e-15);
  const output::SeriesStatistics s = output::statistics(rut.along);
  EXPECT_NEAR(s.sem, 0.01 / std::sqrt(3.0) / std::sqrt(6.0 * 13.0), 4e-4);  // six cells across, white noise
  EXPECT_LT(std::abs(rut.depth - kDepth), 3.0 * s.sem);
}

TEST(Rut, cells_without_grains_are_passed_over) {
  HeightField before = flat(2.65, 0.02), after = pressed(before, 0.5, 2.0);
  for (int ix = 0; ix < after.nx; ++ix) after.height[ix * after.ny + after.ny / 2] = NAN;
  for (int iy = 0; iy < after.ny; ++iy) before.height[(after.nx / 2) * after.ny + iy] = NAN;
  const terrain::Rut rut = terrain::measure_rut(before, after, forward());
  ASSERT_TRUE(rut.measured);
  EXPECT_NEAR(rut.depth, kDepth, 1e-12);
  EXPECT_NEAR(rut.width, kTread, 0.02);
}

TEST(Rut, is_not_measured_without_grains_or_before_the_wheel_has_left_one) {
  EXPECT_FALSE(terrain::measure_rut({}, {}, forward()).measured);
  EXPECT_EQ(terrain::measure_rut({}, {}, forward()).missing, "the ground keeps no rut");
  const HeightField before = flat(2.65, 0.02);
  terrain::RutOptions options = forward();
  options.axle = options.start + 0.5;
  EXPECT_FALSE(terrain::measure_rut(before, before, options).measured);
  EXPECT_EQ(terrain::measure_rut(before, before, options).missing,
            "the axle travelled 0.5 m, and the rut is measured 0.3 to 0.55 m behind it");
  options = forward();
  options.lateral = 10.0;  // outside the cells
  EXPECT_EQ(terrain::measure_rut(before, pressed(before, 0.5, 2.0), options).missing,
            "there are no grains where the tread went");
  EXPECT_EQ(terrain::measure_rut(before, before, options).missing, "the ground keeps no rut");
}

/// Regression: the rut of a wheel of 58 mm was measured 0.3 m behind its axle, where the wheel never was.
TEST(Rut, of_a_small_wheel_is_measured_close_behind_it) {
  const HeightField before = flat(2.65, 0.005);
  const HeightField after = pressed(before, 1.0, 1.15);
  terrain::RutOptions options = forward();
  options.start = 1.0;
  options.axle = 1.15;
  EXPECT_FALSE(terrain::measure_rut(before, after, options).measured);
  options.radius = 0.058;
  const terrain::Rut rut = terrain::measure_rut(before, after, options);
  ASSERT_TRUE(rut.measured);
  EXPECT_NEAR(rut.depth, kDepth, 1e-12);
  EXPECT_TRUE(rut.missing.empty()) << rut.missing;
}

TEST(Rut, an_untouched_bed_has_no_rut_width) {
  const HeightField before = flat(2.65, 0.02);
  const terrain::Rut rut = terrain::measure_rut(before, before, forward());
  EXPECT_EQ(rut.depth, 0.0);
  EXPECT_TRUE(std::isnan(rut.width));
}

}  // namespace
}  // namespace furrow
