#include "protocol/core/outcome.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Outcome, is_good_unless_said_otherwise) {
  const Outcome outcome;
  EXPECT_TRUE(outcome.ok);
  EXPECT_TRUE(outcome.what.empty() && outcome.detail.empty());
}

TEST(Outcome, a_failure_reads_as_one_sentence_of_who_what_where_and_detail) {
  const Outcome outcome = Outcome::failure("did not converge", "residual 0.1, allowed 1e-4");
  EXPECT_FALSE(outcome.ok);
  EXPECT_EQ(outcome.message("tire 0", " at t = 0.1 s"),
            "tire 0 did not converge at t = 0.1 s: residual 0.1, allowed 1e-4");
  EXPECT_EQ(outcome.message("tire 0"), "tire 0 did not converge: residual 0.1, allowed 1e-4");
}

TEST(Outcome, a_failure_without_detail_ends_with_the_place) {
  EXPECT_EQ(Outcome::failure("stopped", "").message("rig", " at t = 0 s"), "rig stopped at t = 0 s");
}

TEST(Outcome, becomes_an_error_of_physics_with_the_same_words) {
  const Outcome outcome = Outcome::failure("lost grain 17", "it left the bin");
  const Error error = physics_error(outcome, "terrain", " at t = 1 s, step 7");
  EXPECT_EQ(error.code(), ExitCode::physics);
  EXPECT_EQ(error.what(), outcome.message("terrain", " at t = 1 s, step 7"));
}

}  // namespace
}  // namespace furrow
