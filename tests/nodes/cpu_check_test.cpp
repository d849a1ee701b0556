// A program built for a processor with more features reports this first, and ends with code 2.
#include "nodes/launch/cpu_check.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace furrow {
namespace {

TEST(CpuCheck, this_build_runs_here) { EXPECT_EQ(launch::missing_instruction_set(), nullptr); }

// cpu_check_elsewhere is linked with the same check, built for a processor with all features.
TEST(CpuCheck, a_program_for_another_processor_says_what_it_lacks) {
  FILE* pipe = popen("'" CPU_CHECK_ELSEWHERE "' 2>&1", "r");
  char text[512] = {};
  const std::size_t length = fread(text, 1, sizeof text - 1, pipe);
  const int status = pclose(pipe);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const std::string said(text, length);
  EXPECT_EQ(said.rfind("furrow: error: this program was built for a processor with ", 0), 0U) << said;
  EXPECT_TRUE(holds(said, "scripts/build.sh --portable"));
  EXPECT_EQ(said.find("main was reached"), std::string::npos) << said;
}

}  // namespace
}  // namespace furrow
