// The command line of `furrow`: its commands, and the user's choice.
#pragma once

#include <span>

#include <CLI/CLI.hpp>

#include "nodes/commands/command.hpp"

namespace furrow::commands {

class CommandLine {
 public:
  /// @param commands  each after the command to which it belongs
  CommandLine(int argc, char** argv, std::span<const Command> commands);
  /// @throws Error
  ExitCode execute();

 private:
  void add(const Command& command);

  CLI::App app_{"Furrow: how much a flexible tire pulls on granular soil, and how deep it sinks.", "furrow"};
  Typed typed_;
  Action chosen_;
};

}  // namespace furrow::commands
