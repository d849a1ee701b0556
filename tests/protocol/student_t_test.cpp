// Reference: tables of Student's t distribution.
#include <gtest/gtest.h>

#include "protocol/core/student_t.hpp"

namespace furrow {
namespace {

TEST(StudentT, matches_the_tables) {
  EXPECT_NEAR(student_t(1), 12.7062, 1e-3);
  EXPECT_NEAR(student_t(2), 4.30265, 1e-4);
  EXPECT_NEAR(student_t(7), 2.36462, 1e-4);
  EXPECT_NEAR(student_t(30), 2.04227, 1e-4);
  EXPECT_NEAR(student_t(1e5), 1.95999, 1e-4);
  EXPECT_NEAR(student_t(4, 0.005), 4.60409, 1e-4);
  EXPECT_NEAR(student_t(10, 0.05), 1.81246, 1e-4);
}

}  // namespace
}  // namespace furrow
