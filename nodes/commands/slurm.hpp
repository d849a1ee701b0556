// `furrow ranks --slurm`: a batch script.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "nodes/commands/commands.hpp"

namespace furrow::commands {

struct SlurmArguments {
  int nodes = 1;
  int cores_per_node = 0;                // 0: whole nodes of any size
  std::string partition, time, account;  // empty: the cluster's defaults
  std::filesystem::path out;             // empty: results/<scenario>-job<job number>
};

/// Adds --slurm, and the options of the job, which need it. @returns --slurm
CLI::Option* add_slurm_options(CLI::App& command, SlurmArguments& job);

/// @throws Error(bad_input)
std::string slurm_script(const scenario::Scenario& scenario, const SlurmArguments& job, const Settings& settings);

}  // namespace furrow::commands
