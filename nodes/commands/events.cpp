// `furrow events`: the events of a vehicle's run, listed by scripts/events.py.
#include <sys/wait.h>

#include <iostream>

#include <fmt/format.h>

#include "nodes/commands/commands.hpp"
#include "nodes/commands/python_script.hpp"
#include "nodes/launch/run_directory.hpp"
#include "nodes/launch/signals.hpp"

namespace furrow::commands {
namespace {

constexpr double kAddressSpace = 512e6;  // bytes; numpy's BLAS waits forever for less

}  // namespace

ExitCode events_command(const EventsArguments& arguments) {
  launch::require_run_directory(arguments.directory);
  launch::require_plain_files(arguments.directory);
  PythonScript script{.name = "events.py",
                      .arguments = {},
                      .folders = {arguments.directory},
                      .what = "the table of events",
                      .address_space = kAddressSpace,
                      .quiet = false,
                      .deadline = std::nullopt};
  if (arguments.from) script.arguments.push_back(fmt::format("--from={}", *arguments.from));
  if (arguments.to) script.arguments.push_back(fmt::format("--to={}", *arguments.to));
  if (arguments.json) script.arguments.emplace_back("--json");
  const Finished finished = run_python(script);
  std::cout << finished.output;
  const int code = WIFEXITED(finished.status) ? WEXITSTATUS(finished.status) : -1;
  if (code == static_cast<int>(ExitCode::done)) return ExitCode::done;
  // These it has explained itself.
  for (const ExitCode told : {ExitCode::bad_input, ExitCode::io})
    if (code == static_cast<int>(told)) return told;
  throw io_error(arguments.directory.string(), launch::stop_signalled()
                                                   ? "the table of events was interrupted"
                                                   : "made no table of events, expected a vehicle's run");
}

}  // namespace furrow::commands
