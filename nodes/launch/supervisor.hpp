// `furrow run` outside MPI: starts mpirun, watches it, shows what the ranks say, passes on a wish to stop,
// and reports in one message what went wrong. No process that it started survives it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/launch/progress.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {

struct Launch {
  std::vector<std::string> arguments;  // of this program in every rank, without its name
  std::vector<scenario::RankEntry> ranks;
  std::size_t polling = 0;    // ranks of one terrain of several: they poll for each other inside its engine
  std::filesystem::path log;  // everything that ranks and launcher say
  int hold = -1;            // descriptor of the folder's lock, which the launcher keeps as long as it lives; −1: none
  double patience = 120.0;  // s without news of ranks that are to start
  double peer_timeout = 60.0;  // s after which ranks give each other up
};

struct LaunchResult {
  ExitCode code = ExitCode::done;
  std::string error;        // for the user, unless done
  std::size_t started = 0;  // ranks that began to work
};

/// The launcher: FURROW_MPIRUN (Open MPI's, or Slurm's srun), else the one of the MPI that this program was built with,
/// else the first on PATH.
/// @throws Error(io) when there is none
std::filesystem::path find_mpirun();

/// @pre catch_stop_signals was called
/// @throws Error(io) when the log cannot be opened, Error(limit) when no process can be made
LaunchResult supervise(const Launch& launch, ProgressDisplay& display);

}  // namespace furrow::launch
