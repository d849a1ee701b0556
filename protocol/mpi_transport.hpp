// The MPI side of protocol/transport.hpp that a program needs beyond messages.
#pragma once

#include <string>
#include <vector>

#include "protocol/transport.hpp"

namespace furrow {

/// The communicator of this rank's role, as MPI_Comm_f2c takes it: for a terrain engine that spans several ranks.
/// It belongs to the transport. @throws Error(bad_input) when the transport is not one of MPI
int role_communicator(const Transport& transport);

/// The variables of the environment by which mpirun, srun and the like tell a process its rank: of
/// OMPI_COMM_WORLD_RANK, PMIX_RANK and PMI_RANK those that are set and not empty. They may be left over from a shell that
/// a launcher started.
std::vector<std::string> launcher_variables();
/// True when there is one of them.
bool launched_by_mpi();
/// The rank of this process: MPI's once it has begun, before that what the first of these variables says, 0 without.
int launched_rank();

}  // namespace furrow
