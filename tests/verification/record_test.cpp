// The records of the verification suite: a check must be able to fail.
#include "tests/verification/record.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace furrow::verification {
namespace {

/// Judges a curve of these values against the reference 1.
void judge(const std::vector<double>& values) {
  Worst worst("a case", "a quantity", 0.1, "this test");
  for (const double value : values) worst.add(value, 1.0);
}

TEST(Record, worst_point_within_tolerance_passes) { judge({1.0, 1.05, 0.98}); }

TEST(Record, worst_point_fails_wherever_it_lies) {
  EXPECT_NONFATAL_FAILURE(judge({1.5, 1.0}), "relative error 0.5");
  EXPECT_NONFATAL_FAILURE(judge({1.0, 1.5}), "relative error 0.5");
}

TEST(Record, nan_fails_wherever_it_lies) {
  EXPECT_NONFATAL_FAILURE(judge({NAN, 1.0, 1.0}), "nan");
  EXPECT_NONFATAL_FAILURE(judge({1.0, NAN, 1.2}), "nan");
  EXPECT_NONFATAL_FAILURE(judge({1.0, 1.0, NAN}), "nan");
}

TEST(Record, curve_without_points_fails) { EXPECT_NONFATAL_FAILURE(judge({}), "no points"); }

}  // namespace
}  // namespace furrow::verification
