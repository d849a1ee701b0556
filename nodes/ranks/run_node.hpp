// The run loop: what one rank does from handshake to final report.
#pragma once

#include "nodes/ranks/run_context.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/transport.hpp"

namespace furrow::ranks {

/// Runs this rank's node to the end. Result files are written by the rank that owns them; the rig's writes the series,
/// the summary and the index. Checkpoints are written as the scenario asks.
/// @returns done, or stopped when a signal ended the run early, after a checkpoint
/// @throws Error; of code io after all results are written where the checkpoint of the end could not be
ExitCode run_node(const scenario::Scenario& scenario, Transport& transport, const RunContext& context);

}  // namespace furrow::ranks
