// Suggestions: a known name for an unknown one, and a unit for an unusual value.
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

TEST(UsualValues, guesses_are_round_and_name_their_unit) {
  EXPECT_EQ(unusual_text(2.2, 5e3, 2e6, "Pa"),
            "2.2 Pa is unusually small, usual is 5000 to 2e6 Pa: did you mean 220e3 (bar) or 15170 (psi)?");
  EXPECT_EQ(unusual_text(30.0, 5e3, 2e6, "Pa"),
            "30 Pa is unusually small, usual is 5000 to 2e6 Pa: did you mean 30e3 (kPa) or 206.8e3 (psi)?");
}

TEST(UsualValues, moduli_are_not_guessed_in_units_of_pressure) {
  EXPECT_EQ(unusual_text(24.9, 1e5, 1e11, "Pa"),
            "24.9 Pa is unusually small, usual is 100e3 to 1e11 Pa: did you mean 2.49e7 (MPa) or 2.49e10 (GPa)?");
}

TEST(UsualValues, shares_are_no_percentages) {
  EXPECT_EQ(unusual_text(90.0, 0.02, 3.0, "-"),
            "90 is unusually large, usual is 0.02 to 3: did you mean 0.9 (per cent)?");
}

TEST(UsualValues, zero_and_usual_values_pass) {
  EXPECT_EQ(unusual_text(0.0, 5e3, 2e6, "Pa"), "");
  EXPECT_EQ(unusual_text(2e5, 5e3, 2e6, "Pa"), "");
  EXPECT_EQ(unusual_text(-5.0, -10.0, 10.0, "m"), "");
}

TEST(UsualValues, an_unnamed_unit_is_guessed_once) {
  EXPECT_EQ(unusual_text(5e3, 1e4, 1e8, "N/m^(n+2)"),
            "5000 N/m^(n+2) is unusually small, usual is 10e3 to 1e8 N/m^(n+2): did you mean 5e6?");
}

}  // namespace
}  // namespace furrow
