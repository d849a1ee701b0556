// The memory that the system grants to a process.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

namespace furrow {

struct MemoryLimit {
  double bytes = std::numeric_limits<double>::infinity();
  std::string name;  // for messages: "ulimit -v", "control group", "this machine"
};

/// Limit of the address space of one process (ulimit -v).
MemoryLimit address_space_limit();

/// Limit for all processes together, however much of it is in use. It is the memory and swap of this machine, or of the
/// control group (version 2 or 1) of this process, whichever is less.
/// @param root  folder that contains /proc and /sys
MemoryLimit memory_limit(const std::filesystem::path& root = "/");

/// Call it before the first dense operation of a sparse solver: without memory for its buffers, OpenBLAS retries for
/// ever.
/// @throws Error(limit) if the address space has no room for them
void require_blas_buffers();

}  // namespace furrow
