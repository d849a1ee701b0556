// Checks whether this machine has the memory for a scenario, and makes the message if memory has run out.
#pragma once

#include "nodes/scenario/scenario.hpp"
#include "protocol/core/error.hpp"

namespace furrow::scenario {

/// @throws Error(limit) if the terrain's rank cannot fit into the memory that this machine gives one process, even
/// without other programs. In doubtful cases there is at most a warning (scenario_checks.cpp).
void require_memory(const Scenario& scenario);

/// "out of memory: needs about 1.2 GB, limit 0.3 GB (ulimit -v)", exit code 6.
/// @param needed  bytes; 0: unknown
Error out_of_memory(double needed = 0.0);

}  // namespace furrow::scenario
