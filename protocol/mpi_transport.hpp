// The MPI side of protocol/transport.hpp that a program needs beyond messages.
#pragma once

namespace furrow {

/// Ends this process at once without MPI_Finalize, which would wait for ranks that no longer answer.
[[noreturn]] void abandon_mpi(int exit_code);

/// True inside mpirun, srun and the like: decided by OMPI_COMM_WORLD_RANK, PMIX_RANK or PMI_RANK alone.
bool launched_by_mpi();
/// The rank they give, 0 outside MPI.
int launched_rank();

}  // namespace furrow
