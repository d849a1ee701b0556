// Walls under the grains of one rank of the engine liggghts: four at a time against the law for each alone. Histories
// are kept when lists are made again and when grains change their numbers.
#include "terrain/liggghts/wall_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::liggghts::wall_contacts_test {
namespace {

constexpr double kRadius = 0.01, kStep = 1e-5, kRoom = 0.002;  // m, s, m
using Rows = std::vector<std::array<double, 3>>;

/// Grains at all walls of a bin, some in its corners, some that touch nothing.
struct Crowd {
  Rows position, velocity, spin, force, torque;
  std::vector<double> radius;
  std::vector<int> id;
  std::vector<std::int32_t> order;
  std::vector<CarriedList> carried;
  dem::Bin bin{0.5, 0.3};

  explicit Crowd(int count = 200) {
    std::mt19937 random(3);
    const auto draw = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
    const auto near = [&](double lo, double hi) {
      const double pick = draw(0.0, 1.0), overlap = draw(-0.5e-3, 0.5e-3);
      return pick < 0.3 ? lo + kRadius - overlap : pick < 0.6 ? hi - kRadius + overlap : draw(lo + 0.05, hi - 0.05);
    };
    for (int g = 0; g < count; ++g) {
      position.push_back({near(0.0, 0.5), near(-0.15, 0.15), near(0.0, 0.4)});
      velocity.push_back({draw(-1, 1), draw(-1, 1), draw(-1, 1)});
      spin.push_back({draw(-50, 50), draw(-50, 50), draw(-50, 50)});
      id.push_back(g + 1);
    }
    radius.assign(count, kRadius);
    carried.resize(count);
    order.resize(count);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    clear();
  }
  void clear() { force.assign(position.size(), {}), torque = force; }
  OwnGrains all() {
    const auto rows = [](Rows& of) { return reinterpret_cast<double(*)[3]>(of.data()); };
    OwnGrains g;
    g.count = static_cast<int>(position.size());
    g.position = rows(position), g.velocity = rows(velocity), g.spin = rows(spin);
    g.force = rows(force), g.torque = rows(torque);
    g.radius = radius.data(), g.id = id.data(), g.carried = carried.data();
    return g;
  }
};

dem::SolverCoefficients coefficients() {
  dem::FewGrains few;
  few.options.radius = kRadius;
  few.options.rolling_friction = 0.1;
  return few.coefficients();
}

/// One step over parts of the order. @param losses  are sampled: one contact after another
/// @tparam kSizes  as if radii differed
template <bool kSizes = false>
void step(WallContacts& walls, Crowd& crowd, dem::ContactTotals& sums, bool losses, int part) {
  static const dem::SolverCoefficients all = coefficients();
  WallContacts::Findings found;
  const OwnGrains grains = crowd.all();
  walls.begin();
  for (int last = std::min(part, grains.count);; last = std::min(last + part, grains.count)) {
    walls.add_forces<dem::MindlinLaw, true, kSizes>(grains, last, {all, kStep, losses}, sums, found);
    if (last == grains.count) break;
  }
  EXPECT_EQ(found.lost, -1);
}

void expect_near(const Rows& a, const Rows& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t g = 0; g < a.size(); ++g)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[g][k], b[g][k], tolerance) << g;
}

TEST(WallContacts, four_at_a_time_are_what_each_is_alone_in_parts_of_any_length) {
  for (const int part : {1, 3, 64, 1000}) {
    Crowd together, alone;
    WallContacts four(together.bin, kRadius), one(alone.bin, kRadius);
    four.list(together.all(), together.order, kRoom);
    one.list(alone.all(), alone.order, kRoom);
    for (int n = 0; n < 5; ++n) {
      dem::ContactTotals sums, expected;
      together.clear(), alone.clear();
      step(four, together, sums, false, part);
      n % 2 == 0 ? step(one, alone, expected, true, 1000) : step<true>(one, alone, expected, false, 1000);
      EXPECT_EQ(sums.contacts, expected.contacts);
      EXPECT_GT(sums.contacts, 100);
      EXPECT_NEAR(sums.elastic, expected.elastic, 1e-12 * expected.elastic);
      EXPECT_NEAR(sums.floor_force, expected.floor_force, 1e-10 * expected.floor_force);
      double most = 0.0;
      for (const auto& f : alone.force) most = std::max({most, std::abs(f[0]), std::abs(f[1]), std::abs(f[2])});
      expect_near(together.force, alone.force, 1e-12 * most);
      expect_near(together.torque, alone.torque, 1e-12 * most * kRadius);
      for (Crowd* crowd : {&together, &alone})  // some open, others close
        for (auto& x : crowd->position) x[0] += 1e-4, x[2] += 0.5e-4;
    }
  }
}

TEST(WallContacts, histories_outlive_new_lists_and_new_numbers) {
  Crowd kept, changed;
  WallContacts still(kept.bin, kRadius), moved(changed.bin, kRadius);
  still.list(kept.all(), kept.order, kRoom);
  moved.list(changed.all(), changed.order, kRoom);
  dem::ContactTotals sums;
  step(still, kept, sums, false, 64), step(moved, changed, sums, false, 64);

  std::reverse(changed.order.begin(), changed.order.end());
  moved.list(changed.all(), changed.order, kRoom);  // another order
  moved.hand_back(changed.all());
  int carried = 0;
  for (const CarriedList& list : changed.carried) carried += static_cast<int>(list.size());
  EXPECT_GT(carried, 100);
  const auto turn = [](auto& all) { std::reverse(all.begin(), all.end()); };
  turn(changed.position), turn(changed.velocity), turn(changed.spin), turn(changed.id), turn(changed.carried);
  moved.list(changed.all(), changed.order, kRoom);
  for (const CarriedList& list : changed.carried) EXPECT_TRUE(list.empty());

  kept.clear(), changed.clear();
  dem::ContactTotals one, other;
  step(still, kept, one, false, 64), step(moved, changed, other, false, 64);
  turn(changed.force), turn(changed.torque);
  EXPECT_EQ(one.contacts, other.contacts);
  expect_near(changed.force, kept.force, 1e-9);
  expect_near(changed.torque, kept.torque, 1e-11);
}

TEST(WallContacts, grains_of_another_engine_get_nothing_of_those_before) {
  Crowd crowd, fewer(3);
  WallContacts walls(crowd.bin, kRadius);
  walls.list(crowd.all(), crowd.order, kRoom);
  dem::ContactTotals sums;
  step(walls, crowd, sums, false, 64);
  walls.forget();
  walls.hand_back(fewer.all());
  for (const CarriedList& list : fewer.carried) EXPECT_TRUE(list.empty());
}

TEST(WallContacts, a_centre_outside_of_the_walls_is_found) {
  Crowd crowd;
  crowd.position[17] = {0.2, 0.0, -1e-3};
  WallContacts walls(crowd.bin, kRadius);
  EXPECT_EQ(walls.list(crowd.all(), crowd.order, kRoom), std::optional<int>(17));
  crowd.position[17] = {0.2, std::numeric_limits<double>::quiet_NaN(), 0.1};
  EXPECT_EQ(walls.list(crowd.all(), crowd.order, kRoom), std::optional<int>(17));
}

}  // namespace
}  // namespace furrow::terrain::liggghts::wall_contacts_test
