// The MPI side of protocol/transport.hpp that a program needs beyond messages.
#pragma once

#include "protocol/transport.hpp"

namespace furrow {

/// Ends this process at once without MPI_Finalize, which would wait for ranks that no longer answer. The way out after
/// ExitCode::rank_lost, once the message is printed; the launcher then ends the other ranks. After other failures
/// return from main: the process waits at its end until all ranks have come there, so print before.
[[noreturn]] void abandon_mpi(int exit_code);

/// The communicator of this rank's role, as MPI_Comm_f2c takes it: for a terrain engine that spans several ranks.
/// It belongs to the transport. @throws Error(bad_input) when the transport is not one of MPI
int role_communicator(const Transport& transport);

/// True inside mpirun, srun and the like: decided by OMPI_COMM_WORLD_RANK, PMIX_RANK or PMI_RANK alone.
bool launched_by_mpi();
/// The rank they give, 0 outside MPI.
int launched_rank();

}  // namespace furrow
