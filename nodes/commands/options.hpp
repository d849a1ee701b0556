// The options of those commands that have many.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "nodes/commands/arguments.hpp"
#include "nodes/commands/bench.hpp"

namespace furrow::commands {

/// A check of an option's value: finite and above 0.
CLI::Validator above_zero();
/// --out and --overwrite of a command that makes a folder. @param usual its name without --out: "<scenario>-NNN"
/// @returns --out
CLI::Option* add_folder_options(CLI::App& command, std::filesystem::path& out, bool& overwrite,
                                const std::string& usual);
void add_grain_bench(CLI::App& command, GrainBench& bench);
void add_tire_bench(CLI::App& command, TireBench& bench);
void add_press_options(CLI::App& command, PressArguments& press);
void add_modes_options(CLI::App& command, ModesArguments& modes);
void add_soil_options(CLI::App& command, SoilArguments& soil);
/// @param wanted whether a batch script is asked for: the options of the job need that
void add_slurm_options(CLI::App& command, bool& wanted, SlurmArguments& job);

}  // namespace furrow::commands
