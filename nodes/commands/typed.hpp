// The user's options, and conversions that most commands need.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "nodes/commands/commands.hpp"
#include "nodes/scenario/load_scenario.hpp"

namespace furrow::commands {

/// The command line, and its settings of a scenario.
struct Typed {
  int argc = 0;
  char** argv = nullptr;
  std::string scenario, threads, until;
  std::vector<std::string> settings;
  double memory = 0.0;  // that the scenario needs, bytes; 0: not known yet
};

/// Adds SCENARIO and its settings.
void add_scenario(CLI::App& command, Typed& typed);
/// Adds --set and --threads.
void add_settings(CLI::App& command, Typed& typed);

/// Converts --set, --threads and --until to keys of the scenario. @throws Error(bad_input)
Settings settings_of(const Typed& typed);

/// Loads the scenario with its settings, prints its warnings, and notes the memory that it needs. @throws Error
scenario::Scenario load(Typed& typed, scenario::Purpose purpose = scenario::Purpose::run);

/// Adds --out and --overwrite to a command that makes a folder. @param usual its name without --out: "<scenario>-NNN"
/// @returns --out
CLI::Option* add_folder_options(CLI::App& command, std::filesystem::path& out, bool& overwrite,
                                const std::string& usual);
void add_no_plots(CLI::App& command, bool& plots);
/// Validator of an option's value: finite and above 0.
CLI::Validator above_zero();

}  // namespace furrow::commands
