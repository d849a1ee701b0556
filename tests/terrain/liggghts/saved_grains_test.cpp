// Saved grains of a rank of the engine liggghts: impossible values are refused with their names.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "protocol/core/error.hpp"
#include "terrain/liggghts/saved_grains.hpp"
#include "tests/refusal.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRadius = 0.05;  // m

/// Grains 0 and 2 of three, which touch; 2 stands on the floor.
Archive saved() {
  std::vector<double> state;
  for (const double x : {0.1, 0.199}) {
    state.push_back(kRadius);
    for (int copy = 0; copy < 3; ++copy) state.insert(state.end(), {x, 0.0, 0.049});
    state.insert(state.end(), 6, 0.01);
  }
  Archive archive;
  archive.put("grains/id", std::vector<std::int32_t>{0, 2});
  archive.put("grains/state", state);
  archive.put("pairs/grains", std::vector<std::int32_t>{0, 2});
  archive.put("pairs/history", std::vector<double>{1.0, 2.0, 3.0, 0.03, 0.0, 0.0, 0.0});
  archive.put("carried/grain", std::vector<std::int32_t>{2});
  archive.put("carried/history", std::vector<double>{4.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0});
  return archive;
}

std::string complaint(const Archive& archive, std::int64_t size = 3) {
  return refusal(ExitCode::io, [&] { read_grains(archive, size); });
}

std::string complaint_of(const std::string& name, std::size_t at, std::int32_t value) {
  Archive archive = saved();
  std::vector<std::int32_t> values = archive.get<std::int32_t>(name);
  values.at(at) = value;
  archive.put(name, values);
  return complaint(archive);
}

TEST(SavedGrains, what_was_saved_is_read) {
  const StartingBed bed = read_grains(saved(), 3);
  ASSERT_EQ(bed.size(), 2);
  EXPECT_EQ(bed.grains[1].id, 2);
  EXPECT_EQ(bed.grains[1].position, (std::array{0.199, 0.0, 0.049}));
  ASSERT_EQ(bed.pairs.size(), 1U);
  EXPECT_EQ(bed.pairs[0].root_overlap, 0.03);
  ASSERT_EQ(bed.walls.size(), 1U);
  EXPECT_EQ(bed.walls[0].contact.partner, 4.0);
}

TEST(SavedGrains, grains_that_there_are_not_are_refused) {
  for (const std::int32_t grain : {-1, 3}) {
    EXPECT_TRUE(holds(complaint_of("grains/id", 0, grain), "'grains/id' names grain"));
    EXPECT_TRUE(holds(complaint_of("pairs/grains", 1, grain), "'pairs/grains' names grain"));
    EXPECT_TRUE(holds(complaint_of("carried/grain", 0, grain), "'carried/grain' names grain"));
  }
  EXPECT_TRUE(holds(complaint(saved(), -1), "'grains/all' is -1"));
}

TEST(SavedGrains, lists_of_wrong_lengths_are_refused) {
  Archive odd = saved();
  odd.put("pairs/grains", std::vector<std::int32_t>{0, 2, 0});
  EXPECT_TRUE(holds(complaint(odd), "'pairs/grains' holds a grain without its partner"));
}

}  // namespace
}  // namespace furrow::terrain::liggghts
