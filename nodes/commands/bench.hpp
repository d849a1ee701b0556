// `furrow bench`: how fast this machine steps grains and tires.
#pragma once

#include <functional>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/core/progress_call.hpp"

namespace furrow::commands {

/// Runs a benchmark that returns one JSON object, shows how far it is, and prints what it found. Warns where there are
/// more threads than cores. @param bench  ends when its progress call throws
ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench);

}  // namespace furrow::commands
