// The account of impulses between a tire that uses contact tangents and its terrain.
#include "nodes/ranks/impulse_ledger.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

NodalForces one_force(int vertex, const Vec3& force) { return {{vertex}, {force}, {ContactTangent()}}; }

TEST(ImpulseLedger, holds_what_acted_less_what_was_reported) {
  ranks::ImpulseLedger ledger(3);
  Vec3 on_tire = Vec3::Zero(), on_terrain = Vec3::Zero();
  for (int n = 0; n < 200; ++n) {
    NodalForces forces = one_force(n % 3, Vec3(n % 5, -3.0 + n % 7, 100.0 + n % 11));
    on_terrain += 1e-4 * forces.force[0];
    ledger.settle(forces, 1e-4);
    EXPECT_LE((ledger.sum() - (on_tire - on_terrain)).norm(), 1e-15 * n);
    ledger.hand_back(forces, 1e-4);
    for (Vec3& f : forces.force) f *= 1.0 + 0.1 * (n % 3);  // change by the tire
    for (const Vec3& f : forces.force) on_tire += 1e-4 * f;
    ledger.book(forces, 1e-4);
  }
  EXPECT_GT(ledger.largest(), 0.0);
  EXPECT_LT(ledger.largest(), 0.1);  // of the 2 N s that were exchanged
}

/// With exactly predicted forces, L falls by the share β in each interval.
TEST(ImpulseLedger, hands_back_a_tenth_each_interval) {
  ranks::ImpulseLedger ledger(1);
  ledger.book(one_force(0, Vec3(0, 0, 2.0)), 1e-4);
  double before = ledger.sum().z();
  for (int n = 0; n < 20; ++n) {
    NodalForces forces = one_force(0, Vec3(0, 0, 100.0));
    ledger.hand_back(forces, 1e-4);
    ledger.book(forces, 1e-4);
    ledger.settle(one_force(0, Vec3(0, 0, 100.0)), 1e-4);
    EXPECT_NEAR(ledger.sum().z() / before, 0.9, 1e-9);
    before = ledger.sum().z();
  }
}

TEST(ImpulseLedger, takes_back_at_most_half_of_a_force_and_pays_where_nothing_touches_any_more) {
  ranks::ImpulseLedger ledger(2);
  ledger.book(one_force(1, Vec3(0, 0, 1000.0)), 1e-4);
  NodalForces forces = one_force(1, Vec3(0, 0, 10.0));
  ledger.hand_back(forces, 1e-4);
  EXPECT_NEAR(forces.force[0].z(), 5.0, 1e-12);
  NodalForces none;
  ledger.hand_back(none, 1e-4);
  ASSERT_EQ(none.vertex, std::vector<int>{1});
  EXPECT_NEAR(none.force[0].z(), -100.0, 1e-9);
}

}  // namespace
}  // namespace furrow
