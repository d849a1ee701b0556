#include "nodes/scenario/memory_check.hpp"

#include <fmt/format.h>

#include "protocol/files/memory_limit.hpp"

namespace furrow::scenario {
namespace {

// Share of the estimate, which is an upper limit: the solver takes 350 of its 900 bytes per grain, and another 300
// while the bed is handed over.
constexpr double kSure = 0.5;
constexpr double kAddressSpace = 600e6;  // bytes of it that program, libraries and stacks of a rank take

std::string gigabytes(double bytes) { return fmt::format("{:.1f} GB", 1e-9 * bytes); }

std::string limit_text(const MemoryLimit& limit) {
  if (limit.name.empty()) return "limit unknown";
  return fmt::format("limit {} ({})", gigabytes(limit.bytes), limit.name);
}

}  // namespace

void require_memory(const Scenario& scenario) {
  for (const MemoryLimit& limit : {address_space_limit(), memory_limit()})
    if (kSure * scenario.memory.terrain > limit.bytes)
      throw limit_error(fmt::format("{}: out of memory: the terrain needs about {}, {}; expected fewer grains",
                                    scenario.file.string(), gigabytes(scenario.memory.terrain), limit_text(limit)));
}

Error out_of_memory(double needed) {
  const MemoryLimit space = address_space_limit(), memory = memory_limit();
  const bool of_space = space.bytes < memory.bytes;
  std::string text = "out of memory: ";
  if (needed > 0.0) text += fmt::format("needs about {}, ", gigabytes(needed + (of_space ? kAddressSpace : 0.0)));
  return limit_error(text + limit_text(of_space ? space : memory));
}

}  // namespace furrow::scenario
