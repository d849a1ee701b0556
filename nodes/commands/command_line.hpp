// The command line of `furrow`: what it understands, and what the user chose.
#pragma once

#include <functional>
#include <utility>

#include <CLI/CLI.hpp>

#include "nodes/commands/arguments.hpp"
#include "nodes/commands/bench.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/commands/typed.hpp"

namespace furrow::commands {

class CommandLine {
 public:
  CommandLine(int argc, char** argv);
  ExitCode execute();

 private:
  /// A command, and what is done when it is the one that was given.
  CLI::App& add(CLI::App& parent, const char* name, const char* purpose, std::function<ExitCode()> action);
  CLI::App& add(const char* name, const char* purpose, std::function<ExitCode()> action) {
    return add(app_, name, purpose, std::move(action));
  }
  /// Commands that serve one task stand together in the help.
  void add_group(const char* task, void (CommandLine::*add_commands)());
  // The groups (command_groups.cpp).
  void add_beginnings();
  void add_runs();
  void add_questions();
  void add_virtual_tests();
  void add_vehicles();
  void add_studies();
  void add_benches();

  int argc_;
  char** argv_;
  CLI::App app_{"Furrow: how much a flexible tire pulls on granular soil, and how deep it sinks.", "furrow"};
  std::function<ExitCode()> chosen_;
  Typed typed_;
  SoilArguments soil_;
  PressArguments press_;
  ModesArguments modes_;
  KinematicsArguments kinematics_;
  NewArguments new_;
  EventsArguments events_;
  SweepArguments sweep_;
  CalibrateArguments calibrate_;
  SlurmArguments slurm_;
  GrainBench grains_;
  TireBench tire_;
};

}  // namespace furrow::commands
