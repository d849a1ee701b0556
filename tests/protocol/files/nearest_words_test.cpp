// Which known name was meant by one that is not known.
#include "protocol/files/nearest_words.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

/// Damerau–Levenshtein distance (optimal string alignment) of known pairs.
TEST(NearestWords, edit_distance_of_known_pairs) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("slip", "SLIP"), 0U);
  EXPECT_EQ(edit_distance("slip", "slpi"), 1U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U);
}

TEST(NearestWords, suggests_only_what_is_near_and_the_nearest_first) {
  EXPECT_EQ(nearest_words("presure", {"radius", "pressures", "pressure"}),
            (std::vector<std::string>{"pressure", "pressures"}));
  EXPECT_TRUE(nearest_words("xyz", {"pressure", "radius"}).empty());
}

TEST(NearestWords, an_unknown_name_is_told_with_what_was_meant_or_with_all_there_is) {
  EXPECT_EQ(unknown_text({"grid", "list"}, {"grid", "list", "set"}), "is unknown, expected 'grid'?");
  EXPECT_EQ(unknown_text({}, {"grid", "list"}), "is unknown, expected one of: grid, list");
}

}  // namespace
}  // namespace furrow
