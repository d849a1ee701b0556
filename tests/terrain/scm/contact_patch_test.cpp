// The width of contact patches against Bekker's b of plates.
#include "terrain/scm/contact_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace furrow::terrain::scm {
namespace {

std::vector<Cell> cells_where(const auto& inside, int half = 120) {
  std::vector<Cell> cells;
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j)
      if (inside(i, j)) cells.push_back({i, j});
  return cells;
}

double patch_width(const std::vector<Cell>& cells, double spacing) {
  PatchFinder finder;
  finder.find(cells);
  EXPECT_EQ(finder.count(), 1);
  return finder.width(0, spacing);
}

TEST(PatchWidth, of_a_long_plate_is_its_width_and_of_a_square_half_its_side) {
  const auto plate = [](int a, int b) {
    return cells_where([=](int i, int j) { return i >= 0 && i < a && j >= 0 && j < b; });
  };
  EXPECT_NEAR(patch_width(plate(100, 2), 0.01), 0.01 * 200.0 / 102.0, 1e-15);
  EXPECT_NEAR(patch_width(plate(20, 20), 0.01), 0.1, 1e-15);
  EXPECT_NEAR(patch_width(plate(1, 1), 0.01), 0.005, 1e-15);
}

TEST(PatchWidth, of_a_disc_is_its_radius_and_does_not_turn_with_a_plate) {
  const auto disc = cells_where([](int i, int j) { return i * i + j * j <= 80 * 80; });
  EXPECT_NEAR(patch_width(disc, 0.001), 0.0805, 2e-4);
  for (const double angle : {0.3, 0.7854, 1.1}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned =
        cells_where([=](int i, int j) { return std::abs(c * i + s * j) <= 80.0 && std::abs(c * j - s * i) <= 30.0; });
    EXPECT_NEAR(patch_width(turned, 0.001) / (0.161 * 0.061 / 0.222), 1.0, 0.02) << angle;
  }
}

TEST(Patches, join_neighbours_and_corners_only) {
  std::vector<Cell> cells{{0, 0}, {0, 1}, {1, 2}, {5, 5}, {6, 4}, {9, 9}, {2, 0}, {1, 0}};
  std::sort(cells.begin(), cells.end());
  std::vector<int> expected;
  for (const Cell& c : cells) expected.push_back(c[0] <= 2 ? 0 : c[0] <= 6 ? 1 : 2);
  PatchFinder finder;
  finder.find(cells);
  EXPECT_EQ(finder.patch(), expected);
  EXPECT_EQ(finder.count(), 3);
  EXPECT_NEAR(finder.width(1, 0.01), 0.01 * 6.0 / (4.0 + 2.0 * std::sqrt(2.0)), 1e-15);  // two cells at a corner
  // A spiral arm that meets its other end at the very last cell.
  const std::vector<Cell> fork{{0, 0}, {0, 4}, {1, 0}, {1, 4}, {2, 1}, {2, 2}, {2, 3}};
  finder.find(fork);
  EXPECT_EQ(finder.patch(), std::vector<int>(7, 0));
}

}  // namespace
}  // namespace furrow::terrain::scm
