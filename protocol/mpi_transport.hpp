// The MPI side of protocol/transport.hpp that a program needs beyond messages.
#pragma once

#include "protocol/transport.hpp"

namespace furrow {

/// The communicator of this rank's role, as MPI_Comm_f2c takes it: for a terrain engine that spans several ranks.
/// It belongs to the transport. @throws Error(bad_input) when the transport is not one of MPI
int role_communicator(const Transport& transport);

/// True inside mpirun, srun and the like: decided by OMPI_COMM_WORLD_RANK, PMIX_RANK or PMI_RANK alone.
bool launched_by_mpi();
/// The rank they give, 0 outside MPI.
int launched_rank();

}  // namespace furrow
