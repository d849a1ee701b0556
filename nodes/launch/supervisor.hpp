// `furrow run` outside MPI: starts mpirun, watches it, shows the ranks' reports, passes on a stop, and reports a
// failure in one message. No process that it started survives it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nodes/launch/progress.hpp"
#include "nodes/scenario/rank_table.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {

struct Launch {
  std::vector<std::string> arguments;  // of this program in every rank, without the program's name
  std::vector<scenario::RankEntry> ranks;
  std::size_t polling = 0;     // ranks of one terrain of several: they poll for each other inside its engine
  std::filesystem::path log;   // all output of ranks and launcher
  int hold = -1;               // descriptor of the folder's lock, which the launcher holds while it lives; −1: none
  double patience = 120.0;     // s without news from starting ranks
  double peer_timeout = 60.0;  // s after which ranks consider each other lost
};

struct LaunchResult {
  ExitCode code = ExitCode::done;
  std::string error;        // for the user, unless done
  std::size_t started = 0;  // ranks that began to work
};

/// The launcher: FURROW_MPIRUN (Open MPI's, or Slurm's srun), otherwise that of the MPI with which this program was
/// built, otherwise the first on PATH.
/// @throws Error(io) if there is none
std::filesystem::path find_mpirun();

/// @pre catch_stop_signals was called
/// @throws Error(io) if the log cannot be opened, Error(limit) if no process can be made
LaunchResult supervise(const Launch& launch, ProgressDisplay& display);

}  // namespace furrow::launch
