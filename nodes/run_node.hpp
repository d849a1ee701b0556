// The run loop: what one rank does from handshake to final report.
#pragma once

#include <filesystem>
#include <functional>

#include "nodes/checkpoint.hpp"
#include "nodes/progress.hpp"
#include "nodes/scenario.hpp"
#include "protocol/archive.hpp"
#include "protocol/transport.hpp"

namespace furrow {

struct RunContext {
  std::filesystem::path directory;               // existing run directory; empty: write nothing (tests)
  int threads = 1;                               // OpenMP threads of this node while stepping
  bool profile = false;                          // record the time of steps
  std::function<bool()> stop_requested;          // a signal asked for a stop
  ProgressSink progress;                         // called by the rig's node
  std::function<void(const std::string&)> note;  // tells the user something
  const ResumePoint* resume = nullptr;           // where the run goes on; null: it begins
  const Archive* saved = nullptr;                // this node's part of that checkpoint; run_node reads it
};

/// Runs this rank's node to the end. Result files are written by the rank that owns them; the rig's writes the series,
/// the summary and the index. Checkpoints are written as the scenario asks.
/// @returns done, or stopped when a signal ended the run early, after a checkpoint
/// @throws Error
ExitCode run_node(const Scenario& scenario, Transport& transport, const RunContext& context);

}  // namespace furrow
