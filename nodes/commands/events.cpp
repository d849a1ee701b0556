// `furrow events`: the events of a vehicle's run, listed by scripts/python/furrow/events.py.
#include <sys/wait.h>

#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/python_script.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"

namespace furrow::commands {
namespace {

struct EventsArguments {
  std::filesystem::path directory;
  std::optional<double> from, to;  // window of the means, s
  bool json = false;
};

ExitCode list_events(const EventsArguments& arguments) {
  launch::require_run_directory(arguments.directory);
  launch::require_plain_files(arguments.directory);
  PythonScript script{.name = "events", .folders = {arguments.directory}, .what = "the table of events"};
  if (arguments.from) script.arguments.push_back(fmt::format("--from={}", *arguments.from));
  if (arguments.to) script.arguments.push_back(fmt::format("--to={}", *arguments.to));
  if (arguments.json) script.arguments.emplace_back("--json");
  const Finished finished = run_python(script);
  std::cout << finished.output;
  const int code = WIFEXITED(finished.status) ? WEXITSTATUS(finished.status) : -1;
  if (code == static_cast<int>(ExitCode::done)) return ExitCode::done;
  // The script has reported these itself.
  for (const ExitCode told : {ExitCode::bad_input, ExitCode::io})
    if (code == static_cast<int>(told)) return told;
  throw io_error(arguments.directory.string(), launch::stop_signalled()
                                                   ? "the table of events was interrupted"
                                                   : "made no table of events, expected a vehicle's run");
}

Action events_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<EventsArguments>();
  command.add_option("DIR", arguments->directory, "Read the run in this folder.")->required();
  command.add_option("--from", arguments->from, "Begin the means at this time, s (default: where they are steady).");
  command.add_option("--to", arguments->to, "End the means at this time, s (default: the end of the run).");
  command.add_flag("--json", arguments->json, "Print JSON.");
  return [arguments] { return list_events(*arguments); };
}

}  // namespace

Command events_entry() {
  return {.name = "events",
          .task = task::compare,
          .purpose = "List what happened in a vehicle's run and when, and compare its axles.",
          .options = events_options,
          .examples = {{"events results/hmmwv_small-001", "List what happened, and compare the axles."}},
          .quiet = false};
}

}  // namespace furrow::commands
