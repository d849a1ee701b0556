// What a saved state may say of the grains of a rank of engine liggghts: what cannot be is refused by name.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "protocol/core/error.hpp"
#include "terrain/liggghts/borders.hpp"
#include "terrain/liggghts/saved_grains.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRadius = 0.05;  // m
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

StartingBed read(const Archive& archive, std::int64_t size = 3) {
  dem::DemOptions options;
  options.radius = kRadius;
  return read_grains(archive, size, 1, options);
}

std::string complaint(const Archive& archive, std::int64_t size = 3) {
  try {
    read(archive, size);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    return error.what();
  }
  return "";
}

template <class Value>
std::string complaint_of(const std::string& name, std::size_t at, Value value) {
  Archive archive = saved();
  std::vector<Value> values = archive.get<Value>(name);
  values.at(at) = value;
  archive.put(name, values);
  return complaint(archive);
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(SavedGrains, what_was_saved_is_read) {
  const StartingBed bed = read(saved());
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
    EXPECT_TRUE(says(complaint_of("grains/id", 0, grain), "'grains/id' names grain"));
    EXPECT_TRUE(says(complaint_of("pairs/grains", 1, grain), "'pairs/grains' names grain"));
    EXPECT_TRUE(says(complaint_of("carried/grain", 0, grain), "'carried/grain' names grain"));
  }
  EXPECT_TRUE(says(complaint_of("grains/id", 0, std::int32_t{2}), "'grains/id' names grain 2 2 times"));
  EXPECT_TRUE(says(complaint_of("pairs/grains", 1, std::int32_t{0}), "a contact of grain 0 with itself"));
  EXPECT_TRUE(says(complaint(saved(), -1), "'grains/all' is -1"));
}

TEST(SavedGrains, numbers_that_nothing_can_be_computed_with_are_refused) {
  for (const double radius : {-kRadius, 0.0, 0.5 * kRadius, 1.01 * kRadius})
    EXPECT_TRUE(says(complaint_of("grains/state", 0, radius), "'grains/state' holds a grain of radius")) << radius;
  EXPECT_TRUE(says(complaint_of("grains/state", 1, 1e7), "'grains/state' holds 1e+07"));
  EXPECT_TRUE(says(complaint_of("grains/state", 31, kNaN), "'grains/state' holds nan"));
  EXPECT_TRUE(says(complaint_of("pairs/history", 3, kNaN), "'pairs/history' holds nan"));
  EXPECT_TRUE(says(complaint_of("carried/history", 7, kNaN), "'carried/history' holds nan"));
  for (const double partner : {-1.0, 100.0})
    EXPECT_TRUE(says(complaint_of("carried/history", 0, partner), "names a wall or a tire that there is not"));
}

TEST(SavedGrains, lists_of_wrong_lengths_are_refused) {
  Archive odd = saved();
  odd.put("pairs/grains", std::vector<std::int32_t>{0, 2, 0});
  EXPECT_TRUE(says(complaint(odd), "'pairs/grains' holds a grain without its partner"));
  Archive many = saved();
  many.put("carried/grain", std::vector<std::int32_t>(kMostCarried + 1, 2));
  many.put("carried/history", std::vector<double>(11 * (kMostCarried + 1)));
  EXPECT_TRUE(says(complaint(many), "'carried/grain' gives grain 2 65 contacts, expected at most 64"));
}

TEST(SavedGrains, borders_that_do_not_rise_within_the_bin_are_refused) {
  check_saved_borders(std::array{0.0, 1.0, 1.0, 4.0}, 4.0);
  for (const auto& borders : {std::array{1.0, 0.5}, {-1.0, 1.0}, {1.0, 4.1}, {1.0, kNaN}})
    EXPECT_THROW(check_saved_borders(borders, 4.0), Error) << borders[0] << ", " << borders[1];
}

}  // namespace
}  // namespace furrow::terrain::liggghts
