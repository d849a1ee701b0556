// `furrow ranks --slurm`: a batch script.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "nodes/commands/commands.hpp"

namespace furrow::commands {

struct SlurmArguments {
  int nodes = 1;
  int cores_per_node = 0;                // 0: whole nodes, whatever they have
  std::string partition, time, account;  // empty: as the cluster has it
  std::filesystem::path out;             // empty: results/<scenario>-job<number of the job>
};

/// --slurm, and the options of the job, which need it. @returns --slurm
CLI::Option* add_slurm_options(CLI::App& command, SlurmArguments& job);

/// @throws Error(bad_input)
std::string slurm_script(const scenario::Scenario& scenario, const SlurmArguments& job, const Settings& settings);

}  // namespace furrow::commands
