// How much memory the system lets a process have.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

namespace furrow {

struct MemoryLimit {
  double bytes = std::numeric_limits<double>::infinity();
  std::string name;  // for people: "ulimit -v", "control group", "this machine"
};

/// Of the address space of one process (ulimit -v).
MemoryLimit address_space_limit();

/// Of all processes together, however much of it is in use: memory and swap of this machine, or of the control
/// group (version 2 or 1) that this process belongs to, whichever is less.
/// @param root  where /proc and /sys are
MemoryLimit memory_limit(const std::filesystem::path& root = "/");

/// Before the first dense operation of a sparse solver: OpenBLAS asks for its buffers for ever where it gets none.
/// @throws Error(limit) where the address space has no room for them
void require_blas_buffers();

}  // namespace furrow
