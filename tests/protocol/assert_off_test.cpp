// FURROW_ASSERT with assertions off in every build. assert_test.cpp is its counterpart.
#ifndef NDEBUG
#define NDEBUG
#endif
#include "protocol/core/assert.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(AssertOff, neither_condition_nor_values_are_evaluated) {
  int calls = 0;
  const auto call = [&] { return ++calls; };
  FURROW_ASSERT(call() < 0, call());
  FURROW_ASSERT(false);
  EXPECT_EQ(call(), 1);
}

}  // namespace
}  // namespace furrow
