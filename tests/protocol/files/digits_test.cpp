// Reference: the numbers as a person would write them.
#include "protocol/files/digits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace furrow {
namespace {

TEST(Digits, three_significant_ones_and_all_before_the_point) {
  EXPECT_EQ(digits(1398.4), "1398");
  EXPECT_EQ(digits(-25.34), "-25.3");
  EXPECT_EQ(digits(2.5), "2.50");
  EXPECT_EQ(digits(0.02534), "0.0253");
  EXPECT_EQ(digits(0.0), "0");
  EXPECT_EQ(digits(-1.8e-16), "0");
  EXPECT_EQ(digits(1.5e-9), "1.5e-09");
  EXPECT_EQ(digits(4.2e9), "4.2e+09");
}

TEST(Digits, value_and_error_end_at_the_same_place) {
  EXPECT_EQ(with_error(1398.4, 40.2), "1398 ± 40");
  EXPECT_EQ(with_error(2.5312, 0.4123), "2.53 ± 0.41");
  EXPECT_EQ(with_error(-0.3, 168.4), "0 ± 168");
  EXPECT_EQ(with_error(25.0, 3.21), "25.0 ± 3.2");
}

/// Regression: "3 ± 0 N" for the wheel of a laboratory.
TEST(Digits, an_error_above_zero_is_never_written_as_zero) {
  for (double error = 1e-11; error < 1e9; error *= 3.7)
    EXPECT_NE(with_error(3.0, error).substr(with_error(3.0, error).find("± ") + 4).find_first_of("123456789"),
              std::string::npos)
        << error << ": " << with_error(3.0, error);
}

TEST(Digits, an_error_that_is_not_finite_is_unknown) {
  EXPECT_EQ(with_error(3.0, std::numeric_limits<double>::infinity()), "3.00 ± unknown");
  EXPECT_EQ(with_error(std::nan(""), std::nan("")), "nan ± unknown");
}

}  // namespace
}  // namespace furrow
