// The MPI side of protocol/transport.hpp that a program needs beyond messages.
#pragma once

#include <string>
#include <vector>

#include "protocol/transport.hpp"

namespace furrow {

/// The variables of the environment by which mpirun, srun and the like give a process its rank: of
/// OMPI_COMM_WORLD_RANK, PMIX_RANK and PMI_RANK those that are set and not empty. They may be left over from a shell
/// that a launcher started.
std::vector<std::string> launcher_variables();
/// True when there is one of them.
bool launched_by_mpi();
/// The rank of this process: MPI's once it has begun, before that what the first of these variables says, 0 without.
int launched_rank();

}  // namespace furrow
