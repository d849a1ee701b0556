// Limits of memory, read from a /proc and /sys made for the test.
#include "protocol/files/memory_limit.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

namespace furrow {
namespace {

namespace fs = std::filesystem;

/// A machine with 8 GB of memory and 2 GB of swap.
class MemoryLimitTest : public ::testing::Test {
 protected:
  MemoryLimitTest() {
    write("proc/meminfo", "MemTotal:        8000000 kB\nMemAvailable:    5000000 kB\nSwapTotal:       2000000 kB\n");
  }
  ~MemoryLimitTest() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }
  void write(const std::string& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  fs::path root_ = fs::temp_directory_path() / ("furrow-memory-limit-" + std::to_string(getpid()));
};

TEST_F(MemoryLimitTest, of_the_machine_is_memory_and_swap) {
  const MemoryLimit limit = memory_limit(root_);
  EXPECT_EQ(limit.bytes, 1024e7);
  EXPECT_EQ(limit.name, "this machine");
}

TEST_F(MemoryLimitTest, of_a_control_group_of_version_2_counts_with_its_swap) {
  write("proc/self/cgroup", "0::/jobs/7\n");
  write("sys/fs/cgroup/jobs/7/memory.max", "3000000000\n");
  write("sys/fs/cgroup/jobs/7/memory.swap.max", "1000000000\n");
  EXPECT_EQ(memory_limit(root_).bytes, 4e9);
  EXPECT_EQ(memory_limit(root_).name, "control group");
  write("sys/fs/cgroup/jobs/memory.max", "1500000000\n");  // that it lies in
  write("sys/fs/cgroup/jobs/memory.swap.max", "0\n");
  EXPECT_EQ(memory_limit(root_).bytes, 1.5e9);
}

TEST_F(MemoryLimitTest, max_is_no_limit) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(memory_limit(root_).name, "this machine");
}

TEST_F(MemoryLimitTest, of_a_control_group_of_version_1) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/box\n4:memory:/box\n");
  write("sys/fs/cgroup/memory/box/memory.limit_in_bytes", "2000000000\n");
  write("sys/fs/cgroup/memory/box/memory.memsw.limit_in_bytes", "2500000000\n");
  EXPECT_EQ(memory_limit(root_).bytes, 2.5e9);
  write("sys/fs/cgroup/memory/box/memory.limit_in_bytes", "9223372036854771712\n");  // none
  write("sys/fs/cgroup/memory/box/memory.memsw.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(memory_limit(root_).name, "this machine");
}

TEST_F(MemoryLimitTest, without_proc_is_unknown) {
  fs::remove_all(root_);
  EXPECT_TRUE(std::isinf(memory_limit(root_).bytes));
  EXPECT_EQ(memory_limit(root_).name, "");
}

TEST(AddressSpaceLimit, is_what_ulimit_says) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &limit), 0);
  if (limit.rlim_cur == RLIM_INFINITY)
    EXPECT_TRUE(std::isinf(address_space_limit().bytes));
  else
    EXPECT_EQ(address_space_limit().bytes, static_cast<double>(limit.rlim_cur));
}

}  // namespace
}  // namespace furrow
