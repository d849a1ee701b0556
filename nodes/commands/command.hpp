// One command of `furrow`: its line in the help, its options, what it does, and examples.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "nodes/commands/typed.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

/// What a command does once its options are parsed. @throws Error
using Action = std::function<ExitCode()>;

/// A command line without the name of the program, and what it is good for.
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
  const char* task;  // the heading that it stands under; null below another command
  const char* purpose;
  /// Adds the options. @returns none for a command that only has commands below it
  Action (*options)(CLI::App& command, Typed& typed);
  std::vector<Example> examples;
  bool quiet = true;  // it prints more than its result, so that it takes --quiet
};

}  // namespace furrow::commands
