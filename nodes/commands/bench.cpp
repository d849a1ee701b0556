#include "nodes/commands/bench.hpp"

#include <iostream>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/host.hpp"

namespace furrow::commands {

ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench) {
  if (const int cores = static_cast<int>(allowed_cores().size()); threads > cores)
    print_warning("--threads {}: this program may use {} cores, more threads than that wait for each other", threads,
                  cores);
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const std::string json = bench(launch::shown_on(display, " during {}"));
  display.clear();
  std::cout << json;
  return ExitCode::done;
}

Command bench_entry() {
  return {.name = "bench",
          .task = task::measure,
          .purpose = "Measure how fast this machine is, and print JSON.",
          .options = [](CLI::App&, Typed&) { return Action(); },
          .examples = {}};
}

}  // namespace furrow::commands
