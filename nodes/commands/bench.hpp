// `furrow bench`: the speed of this machine for grains, tires and whole rigs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nodes/launch/progress.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/progress_call.hpp"

namespace furrow::commands {

/// Runs a benchmark that returns one JSON object, and prints it. Warns if there are more threads than cores.
/// @param bench  shows its progress on the display
ExitCode run_bench(int threads, const std::function<std::string(launch::ProgressDisplay&)>& bench);
/// The same with the progress call of long work, which may throw.
ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench);

/// Value below which the share `p` of the sorted values is.
double quantile(const std::vector<double>& sorted, double p);

}  // namespace furrow::commands
