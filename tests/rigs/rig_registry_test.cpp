#include "rigs/rig_registry.hpp"

#include <gtest/gtest.h>

#include "protocol/core/error.hpp"

using namespace furrow;

TEST(RigRegistry, makes_the_drawbar_rig) { EXPECT_EQ(rigs::make_rig("drawbar", {})->kind(), "drawbar"); }

TEST(RigRegistry, unknown_type_lists_the_valid_ones) {
  try {
    rigs::make_rig("sled", {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("expected drawbar"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("rig.type"), std::string::npos);
  }
}
