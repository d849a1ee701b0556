// Poisson-disk layers.
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/dem/beds/bed_layers.hpp"

namespace furrow::terrain::dem {
namespace {

TEST(BedLayers, samples_keep_their_distance_and_the_walls) {
  const Bin bin{0.5, 0.3};
  const double r = 0.006;
  const std::vector<Quad> s = poisson_layer(bin, r, 7);
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (int w = 0; w < 4; ++w) EXPECT_GE(bin.distance(w, s[i]), r - 1e-15);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(std::hypot(s[i].x - s[j].x, s[i].y - s[j].y), kSpacing * r);
  }
}

TEST(BedLayers, reference_layer_holds_the_reports_25500_grains) {
  const Bin bin{10.0, 0.6};
  const auto count = static_cast<double>(poisson_layer(bin, 0.006, 1).size());
  EXPECT_NEAR(count, 25500.0, 0.02 * 25500.0);
  EXPECT_NEAR(expected_layer_count(bin, 0.006), count, 0.02 * count);
}

TEST(BedLayers, same_seed_same_layers_other_seed_others) {
  const Bin bin{0.3, 0.2};
  const auto a = bed_layers(bin, 0.01, 3, 1), b = bed_layers(bin, 0.01, 3, 1), c = bed_layers(bin, 0.01, 3, 2);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].x, b[k].x);
    EXPECT_EQ(a[k].y, b[k].y);
  }
  EXPECT_TRUE(a.size() != c.size() || a[5].x != c[5].x);
  EXPECT_NE(a.front().x, a[a.size() / 2].x);
}

}  // namespace
}  // namespace furrow::terrain::dem
