// The MPI functions that a program needs beyond protocol/transport.hpp.
#pragma once

#include <string>
#include <vector>

#include "protocol/transport.hpp"

namespace furrow {

/// The environment variables by which mpirun, srun and similar launchers give a process its rank: those of
/// OMPI_COMM_WORLD_RANK, PMIX_RANK and PMI_RANK that are set and not empty. They may be left over from a shell that a
/// launcher started.
std::vector<std::string> launcher_variables();
/// True if at least one of them is set.
bool launched_by_mpi();
/// The rank of this process: from MPI once it has begun, before that from the first of these variables, else 0.
int launched_rank();

}  // namespace furrow
