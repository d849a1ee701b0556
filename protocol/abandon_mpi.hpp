// Ends a process whose ranks no longer answer.
#pragma once

namespace furrow {

/// Ends this process at once, without MPI_Finalize, which would wait for ranks that no longer answer. It is for
/// ExitCode::rank_lost, after the message is printed; the launcher then ends the other ranks. After any other failure
/// return from main, and print first: the process then waits until all ranks have reached their end.
[[noreturn]] void abandon_mpi(int exit_code);

}  // namespace furrow
