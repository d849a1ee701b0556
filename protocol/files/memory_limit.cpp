#include "protocol/files/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kKib = 1024.0;
constexpr double kBlasBuffers = 200e6;  // bytes, including the memory of the solver itself

/// A number in a file; `otherwise` if the file is missing or has no number ("max").
double number_in(const fs::path& file, double otherwise) {
  double value = 0.0;
  std::ifstream in(file);
  return in >> value ? value : otherwise;
}

/// A value of /proc/meminfo, bytes; 0 if there is no line with that name.
double meminfo(const fs::path& root, const std::string& wanted) {
  std::ifstream info(root / "proc/meminfo");
  double kib = 0.0;
  for (std::string name, unit; info >> name >> kib; std::getline(info, unit))
    if (name == wanted + ":") return kKib * kib;
  return 0.0;
}

/// Finds this process's control group in /proc/self/cgroup, for version 2 or for the controller `memory` of version 1.
/// @returns false when it is in none
bool find_group(const fs::path& root, bool version_2, fs::path& group) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (version_2 ? controllers != ",," : controllers.find(",memory,") == std::string::npos) continue;
    group = fs::path(line.substr(second + 1)).relative_path();
    return true;
  }
  return false;
}

/// Calls use(folder) for the group and all groups that contain it; a container may see only the topmost.
template <class Use>
void for_groups(const fs::path& top, fs::path group, const Use& use) {
  for (;; group = group.parent_path()) {
    use(top / group);
    if (group.empty()) return;
  }
}

double group_limit(const fs::path& root) {
  double least = kNone;
  fs::path group;
  const double swap = meminfo(root, "SwapTotal");
  if (find_group(root, true, group))
    for_groups(root / "sys/fs/cgroup", group, [&](const fs::path& folder) {
      least = std::min(least, number_in(folder / "memory.max", kNone) +
                                  std::min(swap, number_in(folder / "memory.swap.max", kNone)));
    });
  if (find_group(root, false, group))
    for_groups(root / "sys/fs/cgroup/memory", group, [&](const fs::path& folder) {
      const double memory = number_in(folder / "memory.limit_in_bytes", kNone);
      least = std::min(least, std::min(memory + swap, number_in(folder / "memory.memsw.limit_in_bytes", kNone)));
    });
  return least;
}

}  // namespace

MemoryLimit address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  return {static_cast<double>(limit.rlim_cur), "ulimit -v"};
}

MemoryLimit memory_limit(const fs::path& root) {
  const double machine = meminfo(root, "MemTotal") + meminfo(root, "SwapTotal"), group = group_limit(root);
  if (group < machine || (machine == 0.0 && group < kNone)) return {group, "control group"};
  if (machine == 0.0) return {};
  return {machine, "this machine"};
}

void require_blas_buffers() {
  static bool are_there = false;
  if (are_there) return;
  const MemoryLimit limit = address_space_limit();
  const double in_use = number_in("/proc/self/statm", 0.0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (in_use + kBlasBuffers > limit.bytes)
    throw limit_error(fmt::format("out of memory: the solver needs {:.0f} MB of address space, limit {:.0f} MB ({})",
                                  1e-6 * (in_use + kBlasBuffers), 1e-6 * limit.bytes, limit.name));
  are_there = true;
}

}  // namespace furrow
