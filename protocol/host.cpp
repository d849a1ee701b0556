#include "protocol/host.hpp"

#include <sched.h>

#include <fstream>
#include <set>
#include <string>

namespace furrow {

std::vector<int> allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return {0};  // more than 1024 CPUs: unknown, use one
  std::vector<int> cores;
  std::set<std::string> seen;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    // CPUs of one core list the same siblings. Without /sys (a bare chroot) every CPU counts as a core.
    std::ifstream file("/sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/topology/thread_siblings_list");
    std::string siblings;
    if (file >> siblings && !seen.insert(siblings).second) continue;
    cores.push_back(cpu);
  }
  return cores.empty() ? std::vector<int>{0} : cores;
}

std::filesystem::path this_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

}  // namespace furrow
