// The way out of a run whose ranks no longer answer.
#pragma once

namespace furrow {

/// Ends this process at once without MPI_Finalize, which would wait for ranks that no longer answer. The way out after
/// ExitCode::rank_lost, once the message is printed; the launcher then ends the other ranks. After other failures
/// return from main: the process waits at its end until all ranks have come there, so print before.
[[noreturn]] void abandon_mpi(int exit_code);

}  // namespace furrow
