// The lists of the engine liggghts against a search over all pairs of grains, and the histories in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "terrain/liggghts/plugin/pair_lists.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRadius = 0.01, kSkin = 0.002;         // m
constexpr double kLength = 0.3, kWidth = 0.1;           // of the part, m
constexpr double kReach = 2.0 * 1.2 * kRadius + kSkin;  // of the largest grains

/// Own grains in a part of a bin, then ghosts beside it.
struct Crowd {
  std::vector<std::array<double, 3>> place;
  std::vector<double> radius;
  std::vector<const double*> row;
  int own = 0;

  explicit Crowd(unsigned seed, int own_count = 400, int ghosts = 60) : own(own_count) {
    std::mt19937 random(seed);
    const auto within = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
    for (int i = 0; i < own + ghosts; ++i) {
      const bool left = i % 2 == 0;
      const double x = i < own ? within(-0.1 * kSkin, kLength + 0.1 * kSkin)
                       : left  ? within(-kReach, 0.0)
                               : within(kLength, kLength + kReach);
      place.push_back({x, within(-0.5 * kWidth - kReach, 0.5 * kWidth + kReach), within(0.0, 0.1)});
      radius.push_back(within(0.8, 1.2) * kRadius);
    }
    for (const auto& at : place) row.push_back(at.data());
  }
  PairLists::Grains grains() const {
    return {row.data(), radius.data(), own, static_cast<int>(row.size()), 0.0, kLength};
  }
  double gap(int i, int j) const {
    double d2 = 0.0;
    for (int k = 0; k < 3; ++k) d2 += (place[i][k] - place[j][k]) * (place[i][k] - place[j][k]);
    return std::sqrt(d2) - radius[i] - radius[j];
  }
};

using Pairs = std::multiset<std::pair<int, int>>;

PairLists lists_of(bool rolling = true) {
  PairLists lists;
  lists.set_up({kSkin, 1.2 * kRadius, kWidth, rolling});
  return lists;
}

Pairs listed(PairLists& lists) {
  Pairs found;
  for (int row = 0; row < lists.rows(); ++row)
    for (int e = lists.begin(row); e < lists.end(row); ++e)
      found.insert(std::minmax<int>(lists.grain(row), lists.partner()[e]));
  return found;
}

TEST(PairLists, each_pair_closer_than_the_skin_is_listed_once) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Crowd crowd(seed);
    Pairs near;
    for (int i = 0; i < crowd.own; ++i)
      for (int j = i + 1; j < static_cast<int>(crowd.row.size()); ++j)
        if (crowd.gap(i, j) < kSkin) near.insert({i, j});
    ASSERT_GT(near.size(), 300U);
    PairLists lists = lists_of();
    lists.make(crowd.grains());
    EXPECT_EQ(listed(lists), near) << seed;
  }
}

TEST(PairLists, no_grains_have_no_pairs) {
  PairLists lists = lists_of();
  lists.make(Crowd(1, 0, 0).grains());
  EXPECT_EQ(lists.rows(), 0);
  lists.make(Crowd(1, 0, 10).grains());
  EXPECT_EQ(lists.rows(), 0);
}

/// The history of a pair in the direction of its lower number.
PairHistory of_lower(int i, int j, const PairHistory& h) { return i < j ? h : h.turned(); }

PairHistory some_history(int i, int j) { return {{1.0 + i, 2.0 + j, -3.0, 0.5 + i}, {4.0 + j, 5.0, 6.0 + i, 0.0}}; }

/// Grains change their places in the grid, and so may pairs: then the other grain lists them, with the sign turned.
TEST(PairLists, histories_are_kept_when_lists_are_made_again) {
  Crowd crowd(7);
  PairLists lists = lists_of();
  lists.make(crowd.grains());
  Pairs touching;
  for (int row = 0; row < lists.rows(); ++row)
    for (int e = lists.begin(row); e < lists.end(row); ++e) {
      const int i = lists.grain(row), j = lists.partner()[e];
      if (crowd.gap(i, j) > 0.0) continue;
      lists.remember(e, of_lower(i, j, some_history(std::min(i, j), std::max(i, j))));
      touching.insert(std::minmax(i, j));
    }
  ASSERT_GT(touching.size(), 200U);
  std::vector<std::pair<int, int>> first;
  lists.for_touching([&](int i, int j, int) { first.emplace_back(i, j); });
  // All grains move equally, by more than a cell: no pair parts, but the order of the rows changes.
  for (auto& at : crowd.place) at[0] += 0.3 * kReach, at[1] = -at[1];
  lists.make(crowd.grains());
  Pairs kept;
  int turned = 0;
  lists.for_touching([&](int i, int j, int entry) {
    kept.insert(std::minmax(i, j));
    turned += std::find(first.begin(), first.end(), std::pair(j, i)) != first.end() ? 1 : 0;
    const PairHistory h = of_lower(i, j, lists.history(entry)), was = some_history(std::min(i, j), std::max(i, j));
    for (const auto& [now, then] : {std::pair(h.tangential, was.tangential), std::pair(h.rolling, was.rolling)}) {
      EXPECT_EQ(now.x, then.x);
      EXPECT_EQ(now.y, then.y);
      EXPECT_EQ(now.z, then.z);
      EXPECT_EQ(now.w, then.w);
    }
  });
  EXPECT_EQ(kept, touching);
  EXPECT_GT(turned, 20);
}

TEST(PairLists, dropped_lists_hand_nothing_on) {
  const Crowd crowd(3);
  PairLists lists = lists_of(false);
  lists.make(crowd.grains());
  lists.remember(0, some_history(0, 1));
  lists.drop();
  lists.make(crowd.grains());
  lists.for_touching([](int, int, int) { ADD_FAILURE() << "a pair remembers"; });
}

/// A grain that is not a number ends the run elsewhere; the search must survive it.
TEST(PairLists, a_grain_that_is_not_a_number_or_far_away_is_no_harm) {
  Crowd crowd(5);
  crowd.place[3] = {NAN, 0.0, 0.0};
  crowd.place[4] = {0.1, NAN, 1e300};
  crowd.place[5] = {-1e300, 1e300, 1e6};
  PairLists lists = lists_of();
  lists.make(crowd.grains());
  const Pairs found = listed(lists);
  EXPECT_GT(found.size(), 300U);
  for (const auto& [i, j] : found) EXPECT_FALSE((i >= 3 && i <= 5) || (j >= 3 && j <= 5)) << i << ' ' << j;
}

}  // namespace
}  // namespace furrow::terrain::liggghts
