// The machine that a node shares with other nodes.
#pragma once

#include <filesystem>
#include <vector>

#include "protocol/messages.hpp"

namespace furrow {

/// A node and the processor cores that its process may use: one logical CPU number per physical core, increasing.
struct HostNode {
  Address node;
  std::vector<int> cores;
  bool self = false;  // this process
};

/// Cores that this process may use; logical CPUs that share a core count once. Never empty.
std::vector<int> allowed_cores();

/// The file of the running program; empty if the system does not name it.
std::filesystem::path this_program();

}  // namespace furrow
