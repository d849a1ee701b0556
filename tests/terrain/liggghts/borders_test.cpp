// Borders between ranks in a bed with unequal numbers of grains along travel.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "protocol/core/rank_group.hpp"
#include "terrain/liggghts/borders.hpp"

namespace furrow::terrain::liggghts {
namespace {

/// Places of a heap: twice as many grains in each metre as in the one before it.
std::vector<double> heap(double length) {
  std::vector<double> places;
  for (int metre = 0, count = 1000; metre < length; ++metre, count *= 2)
    for (int k = 0; k < count; ++k) places.push_back(metre + (k + 0.5) / count);
  return places;
}

std::vector<std::int64_t> owned(const std::vector<double>& places, const std::vector<double>& borders) {
  std::vector<std::int64_t> counts(borders.size() + 1, 0);
  for (const double x : places) {
    std::size_t rank = 0;
    while (rank < borders.size() && x >= borders[rank]) ++rank;
    ++counts[rank];
  }
  return counts;
}

/// In equal parts the last of four ranks has 8/15 of the grains: 113 % more than the mean.
TEST(Borders, a_heap_is_parted_into_equal_numbers) {
  constexpr double kLength = 4.0;
  const std::vector<double> places = heap(kLength);
  EXPECT_NEAR(imbalance(owned(places, {1.0, 2.0, 3.0})), 8.0 / 15.0 * 4.0 - 1.0, 1e-12);
  Crowd crowd(kLength);
  for (const double x : places) crowd.add(x);
  EXPECT_LT(imbalance(owned(places, crowd.borders(4))), 0.01);
}

TEST(Borders, the_crowd_of_all_ranks_is_the_sum_of_theirs) {
  constexpr double kLength = 4.0;
  const std::vector<double> places = heap(kLength);
  Crowd all(kLength), left(kLength), right(kLength);
  for (const double x : places) all.add(x), (x < 2.0 ? left : right).add(x);
  std::vector<std::int64_t> both(left.counts().begin(), left.counts().end());
  both.insert(both.end(), right.counts().begin(), right.counts().end());
  left.set_sum_of(both);
  EXPECT_EQ(left.borders(3), all.borders(3));
}

TEST(Borders, no_grains_have_no_borders) {
  EXPECT_TRUE(Crowd(1.0).borders(2).empty());
  EXPECT_EQ(imbalance(std::array<std::int64_t, 2>{0, 0}), 0.0);
}

}  // namespace
}  // namespace furrow::terrain::liggghts
