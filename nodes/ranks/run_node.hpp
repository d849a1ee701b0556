// The run loop: one rank's work from the handshake to the final report.
#pragma once

#include "nodes/ranks/run_context.hpp"
#include "nodes/scenario/scenario.hpp"
#include "protocol/transport.hpp"

namespace furrow::ranks {

/// Runs this rank's node to the end. Each rank writes its own files; the rig's rank writes the series, the summary and
/// the index. Checkpoints are written as the scenario sets.
/// @returns done, or stopped when a signal ended the run early, after a checkpoint
/// @throws Error; with code io, after all results are written, if the final checkpoint could not be written
ExitCode run_node(const scenario::Scenario& scenario, Transport& transport, const RunContext& context);

}  // namespace furrow::ranks
