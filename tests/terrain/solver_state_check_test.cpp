// Saved states with valid checksums and invalid numbers: they are refused with the array's name, and never used.
#include "terrain/dem/solver_state_check.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/few_grains.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kStep = 1e-6;  // s

FewGrains rough_grains() {
  FewGrains few;
  few.gravity = 9.81;
  few.options.rolling_friction = 0.1;
  few.options.radius = 0.02;
  return few;
}

/// Saves two layers of grains that touch each other and the floor, with histories.
Archive saved() {
  std::vector<Quad> positions;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 2; ++k)
        positions.push_back({0.05 + 0.0399 * i, -0.1 + 0.0399 * j, 0.0199 + 0.0399 * k, 0.02});
  GrainSolver solver = rough_grains().make(positions);
  for (int step = 0; step < 20; ++step) solver.step(kStep);
  Archive archive;
  solver.save(archive);
  return archive;
}

/// A row of grains across a bed that is cut into parcels; all but one sleep.
FewGrains wide_grains() {
  FewGrains few = rough_grains();
  few.options.width = 2.6;
  few.activity = true;
  return few;
}
Archive saved_asleep() {
  const FewGrains few = wide_grains();
  const double z = few.resting_height();
  std::vector<Quad> positions;
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 2; ++i) positions.push_back({0.1 + 0.041 * i, -1.2 + 0.041 * j, z, 0.0});
  GrainSolver solver = few.make(positions);
  for (int step = 0; step < 100; ++step) solver.step(kStep);
  EXPECT_EQ(solver.accounts().active, 0);
  solver.wake(solver.index_of(7));
  solver.step(kStep);
  EXPECT_GT(solver.accounts().active, 0);
  EXPECT_LT(solver.accounts().active, 20);
  Archive archive;
  solver.save(archive);
  return archive;
}

/// The error of restoring; empty if there is none, and the state can then be stepped.
std::string complaint(const Archive& archive, const FewGrains& few = rough_grains()) {
  GrainSolver solver = few.make({});
  return refusal(ExitCode::io, [&] {
    solver.restore(archive);
    for (int step = 0; step < 3; ++step) solver.step(kStep);
  });
}

template <class T>
Archive with(const Archive& good, const std::string& name, std::size_t at, T value) {
  Archive archive = good;
  std::vector<T> values = good.get<T>(name);
  values.at(at) = value;
  archive.put(name, values);
  return archive;
}

TEST(SolverState, a_saved_one_comes_back) {
  const Archive archive = saved();
  EXPECT_EQ(complaint(archive), "");
  EXPECT_FALSE(archive.get<double>("pairs/tangential").empty());
  EXPECT_FALSE(archive.get<std::int32_t>("walls/grain").empty());
}

TEST(SolverState, every_index_that_is_wild_is_refused_by_its_array) {
  const Archive good = saved();
  const auto refused = [&](const Archive& archive, const std::string& array) {
    EXPECT_TRUE(complaint(archive).starts_with("saved state '" + array + "'")) << array << ": " << complaint(archive);
  };
  constexpr std::int32_t kWild = 1 << 30;
  for (const std::int32_t value : {-1, kWild}) {
    refused(with(good, "id", 3, value), "id");
    refused(with(good, "strips/pairs", 1, value), value < 0 ? "strips/pairs" : "pairs/partners");
    refused(with(good, "strips/walls", 1, value), value < 0 ? "strips/walls" : "walls/grain");
    refused(with(good, "walls/grain", 0, value), "walls/grain");
    refused(with(good, "walls/wall", 0, value), "walls/wall");
    refused(with(good, "strips/cells", 5, value), "strips/cells");
  }
  refused(with(good, "strips/first", 1, std::int32_t{7}), "strips/first");
  refused(with(good, "strips/last", good.get<std::int32_t>("strips/last").size() - 1, kWild), "strips/last");
  refused(with(good, "pairs/partners", 0, ~std::uint64_t{0}), "pairs/partners");
  refused(with(good, "pairs/partners", 0, std::uint64_t{1}), "pairs/partners");
  refused(with(good, "position", 0, std::nan("")), "position");
  refused(with(good, "position", 2, 1e7), "position");
  for (const double radius : {-0.02, 0.0, 0.01, 0.0202}) refused(with(good, "position", 3, radius), "position");
  refused(with(good, "count", 0, std::int64_t{-1}), "count");
  refused(with(good, "count", 0, std::int64_t{1} << 62), "count");
  refused(with(good, "strips/cells_z", 0, std::numeric_limits<std::int64_t>::max()), "strips/cells_z");
  refused(with(good, "strips/cells_z", 0, std::int64_t{0}), "strips/cells_z");
  refused(with(good, "strips/resorted", 0, std::int64_t{-5}), "strips/resorted");
  for (const char* name : {"pairs/tangential", "pairs/rolling"}) {
    Archive archive = good;
    archive.put(name, std::vector<double>(4));
    refused(archive, name);
  }
  Archive archive = good;
  archive.put("samples/strips", std::vector<double>{1.0, 2.0, 3.0});
  refused(archive, "samples/strips");
  archive = good;
  archive.put("mean_contact_force", -1.0);
  refused(archive, "mean_contact_force");
}

/// Changes any numbers to any values and cuts arrays short: restoring must end in a message, or in a state that can be
/// stepped. For more cases: --gtest_shuffle --gtest_repeat=1000.
void change_at_random(const Archive& good, const FewGrains& few) {
  std::mt19937_64 random(static_cast<unsigned>(::testing::UnitTest::GetInstance()->random_seed()));
  std::vector<std::string> names;
  for (const auto& [name, array] : good.arrays()) names.push_back(name);
  int refused = 0;
  for (int k = 0; k < 1000; ++k) {
    const std::string& name = names[random() % names.size()];
    Archive::Array array = good.arrays().at(name);
    std::visit(
        [&]<class T>(std::vector<T>& values) {
          if (values.empty() || random() % 8 == 0) return values.resize(random() % (values.size() + 3));
          constexpr std::int64_t kOdd[] = {0,
                                           1,
                                           -1,
                                           2,
                                           127,
                                           255,
                                           1 << 20,
                                           std::numeric_limits<std::int32_t>::max(),
                                           std::numeric_limits<std::int32_t>::min()};
          T& value = values[random() % values.size()];
          value = random() % 2 ? static_cast<T>(kOdd[random() % std::size(kOdd)]) : static_cast<T>(value + T{1});
        },
        array);
    Archive archive = good;
    archive.put_array(name, array);
    refused += !complaint(archive, few).empty();
  }
  EXPECT_GT(refused, 100);
}

TEST(SolverState, random_changes_are_refused_or_harmless) { change_at_random(saved(), rough_grains()); }
TEST(SolverState, random_changes_of_sleeping_parcels_are_refused_or_harmless) {
  change_at_random(saved_asleep(), wide_grains());
}

TEST(SolverState, parcels_need_all_their_columns_and_lists_in_order) {
  const Archive good = saved_asleep();
  EXPECT_EQ(complaint(good, wide_grains()), "");
  Archive cut = good;
  cut.put("parcels/calm", std::vector<std::int32_t>(3));
  EXPECT_NE(complaint(cut, wide_grains()), "");
  EXPECT_NE(complaint(with(good, "parcels/measured_force", 1, -1.0), wide_grains()), "");
  const auto& partners = good.get<std::uint64_t>("pairs/partners");
  ASSERT_GT(partners.size(), 2U);
  EXPECT_TRUE(complaint(with(good, "pairs/partners", 0, std::uint64_t{kQuad} << 32 | 2 * kQuad), wide_grains())
                  .starts_with("saved state 'pairs/partners' lists the grains of strip"));
  EXPECT_TRUE(complaint(with(good, "walls/grain", 1, std::int32_t{0}), wide_grains()).empty());
  EXPECT_TRUE(complaint(with(good, "walls/grain", 0, std::int32_t{5}), wide_grains())
                  .starts_with("saved state 'walls/grain' lists the grains of strip"));
}

}  // namespace
}  // namespace furrow::terrain::dem
