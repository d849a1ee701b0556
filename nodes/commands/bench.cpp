#include "nodes/commands/bench.hpp"

#include <iostream>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/launch/progress.hpp"
#include "nodes/launch/signals.hpp"
#include "protocol/host.hpp"

namespace furrow::commands {

ExitCode run_bench(int threads, const std::function<std::string(const ProgressCall&)>& bench) {
  if (const int cores = static_cast<int>(allowed_cores().size()); threads > cores)
    print_warning(fmt::format("--threads {}: this program may use {} cores, more threads than that wait for each other",
                              threads, cores));
  launch::catch_stop_signals();
  launch::ProgressDisplay display;
  const std::string json = bench([&](const std::string& what, double share) {
    if (launch::stop_signalled()) throw Error(ExitCode::stopped, "stopped by a signal during " + what);
    display.show({.phase = what, .share = share});
  });
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
