// One command of `furrow`: its line in the help, its options, its action, and examples.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "nodes/commands/typed.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

/// Action of a command after its options are parsed. @throws Error
using Action = std::function<ExitCode()>;

/// A command line without the name of the program, and its purpose.
struct Example {
  std::string_view line, purpose;
};

/// Headings of the help, in its order.
namespace task {
inline constexpr char begin[] = "Begin";
inline constexpr char run[] = "Run";
inline constexpr char ask[] = "Ask before a run";
inline constexpr char test[] = "Test tires, soils and vehicles";
inline constexpr char compare[] = "Compare and look";
inline constexpr char measure[] = "Measure this machine";
}  // namespace task

struct Command {
  const char* name;  // "run"; "bench tire": a command below the command `bench`
  const char* task;  // its heading in the help; null for a command below another one
  const char* purpose;
  /// Adds the options. @returns none for a command that only has commands below it
  Action (*options)(CLI::App& command, Typed& typed);
  std::vector<Example> examples;
  bool quiet = true;  // it prints more than its result, so it has --quiet
};

}  // namespace furrow::commands
