// Every law of the table has the properties of law_promises.hpp, and keys and messages agree with the table.
#include "terrain/dem/contact/laws.hpp"

// The laws are plain scalar code: none of their headers includes simd.hpp, whose Float8 would be found here.
struct Float8 {};
namespace furrow::simd {
static_assert(std::is_class_v<Float8>);
}

#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/law_promises.hpp"

namespace furrow::terrain::dem::testing {
namespace {

using AllLaws = TypesOf<Laws>::type;
INSTANTIATE_TYPED_TEST_SUITE_P(Table, LawPromises, AllLaws, NameOfLaw);

TEST(Laws, are_found_by_name_and_an_unknown_name_lists_them) {
  int place = 0;
  for_each_law([&](auto law) {
    EXPECT_EQ(law_from(law.kName), LawKind{place++});
    EXPECT_STREQ(law_name(law_from(law.kName)), law.kName);
    EXPECT_TRUE(holds(law_names(), law.kName));
  });
  EXPECT_EQ(law_names(), "mindlin or hertz_tanh");
  expect_refused(ExitCode::bad_input, {"expected " + law_names()}, [] { law_from("hooke"); });
}

TEST(Laws, are_chosen_with_rolling_and_sizes) {
  for_each_law([&](auto law) {
    for (const bool rolling : {false, true})
      for (const bool sizes : {false, law.kSizes})
        with_law(law_from(law.kName), rolling, sizes, [&](auto chosen, auto rolls, auto sized) {
          EXPECT_STREQ(chosen.kName, law.kName);
          EXPECT_EQ(rolls, rolling);
          EXPECT_EQ(sized, sizes);
        });
  });
}

TEST(Laws, get_their_coefficients_back_as_they_were_mixed) {
  for_each_law([&](auto law) {
    using Law = decltype(law);
    const auto c = coefficients_of<Law>();
    const ContactCoefficients box(c);
    const auto floats = box.of<Law, float>();
    EXPECT_TRUE(same_bits(box.of<Law>(), c));
    EXPECT_EQ(floats.stiffness, static_cast<float>(c.stiffness));
    EXPECT_EQ(floats.rolling_radius, static_cast<float>(c.rolling_radius));
  });
}

}  // namespace
}  // namespace furrow::terrain::dem::testing
