// What the user typed, and what most commands make of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "nodes/commands/commands.hpp"
#include "nodes/scenario/scenario.hpp"

namespace furrow::commands {

/// As CLI11 fills it in. The options of commands that have many are in arguments.hpp.
struct Typed {
  std::string scenario, threads, key, directory, soil, until, vtk;
  std::filesystem::path out;
  std::vector<std::string> settings, others;
  bool overwrite = false, profile = false, json = false, no_plots = false, slurm = false;
  std::optional<int> seeds, jobs;
  double memory = 0.0;  // that the scenario needs, bytes; 0: not known yet
};

/// SCENARIO and what may be set of it.
void add_scenario(CLI::App& command, Typed& typed);
/// --set and --threads.
void add_settings(CLI::App& command, Typed& typed);

/// --set, --threads and --until as keys of the scenario. @throws Error(bad_input)
Settings settings_of(const Typed& typed);

/// The scenario, with its settings; prints its warnings, and notes the memory that it needs. @throws Error
scenario::Scenario load(Typed& typed);

}  // namespace furrow::commands
