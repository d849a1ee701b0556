// `furrow bench`: the speed of this machine for grains and tires.
#pragma once

#include <functional>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/core/progress_call.hpp"

namespace furrow::commands {

/// Runs a benchmark that returns one JSON object, shows its progress, and prints the result. Warns if there are more
/// threads than cores. @param bench  ends when its progress call throws
ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench);

}  // namespace furrow::commands
