#include "nodes/commands/bench.hpp"

#include <algorithm>
#include <iostream>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/host.hpp"

namespace furrow::commands {

ExitCode run_bench(int threads, const std::function<std::string(launch::ProgressDisplay&)>& bench) {
  if (const int cores = static_cast<int>(allowed_cores().size()); threads > cores)
    print_warning("--threads {}: this program may use {} cores, more threads than that wait for each other", threads,
                  cores);
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const std::string json = bench(display);
  display.clear();
  std::cout << json;
  return ExitCode::done;
}

ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench) {
  return run_bench(threads,
                   [&](launch::ProgressDisplay& display) { return bench(launch::shown_on(display, " during {}")); });
}

double quantile(const std::vector<double>& sorted, double p) {
  FURROW_ASSERT(!sorted.empty() && std::is_sorted(sorted.begin(), sorted.end()), sorted.size());
  FURROW_ASSERT(p >= 0.0 && p <= 1.0, p);
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(p * static_cast<double>(sorted.size())))];
}

Command bench_entry() {
  return {.name = "bench",
          .task = task::measure,
          .purpose = "Measure how fast this machine is, and print JSON.",
          .options = [](CLI::App&, Typed&) { return Action(); },
          .examples = {}};
}

}  // namespace furrow::commands
