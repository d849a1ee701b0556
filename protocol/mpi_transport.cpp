#include "protocol/mpi_transport.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/assert.hpp"
#include "protocol/mpi_session.hpp"
#include "protocol/mpi_wire.hpp"
#include "protocol/node_transport.hpp"

namespace furrow {
namespace {

std::vector<int> gather(const Communicator& comm, const std::vector<int>& own, std::vector<int>& counts) {
  int count = static_cast<int>(own.size());
  counts.resize(comm.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm.get());
  std::vector<int> starts(counts.size() + 1, 0);
  for (std::size_t i = 0; i < counts.size(); ++i) starts[i + 1] = starts[i] + counts[i];
  std::vector<int> all(starts.back());
  MPI_Allgatherv(own.data(), count, MPI_INT, all.data(), counts.data(), starts.data(), MPI_INT, comm.get());
  return all;
}

/// World rank and cores of every process on this machine.
std::vector<HostNode> gather_host_nodes(int tire_count) {
  const Communicator machine = Communicator::machine(MPI_COMM_WORLD);
  std::vector<int> own{world_rank()}, counts;
  for (const int core : allowed_cores()) own.push_back(core);
  const std::vector<int> all = gather(machine, own, counts);
  std::vector<HostNode> nodes;
  auto at = all.begin();
  for (const int count : counts) {
    nodes.push_back({address_of(*at, tire_count), {at + 1, at + count}, *at == world_rank()});
    at += count;
  }
  return nodes;
}

/// "PMI_RANK=1" and how to unset it; empty if no launcher's variables are set.
std::string launcher_text(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  return fmt::format("the environment has {}={}, which a launcher of MPI sets; without a launcher unset {}",
                     names.front(), std::getenv(names.front().c_str()), fmt::join(names, " "));
}

/// A single rank may have been started without a launcher, in an environment with a launcher's variables.
Error wrong_count(int needed, int tires, int terrain_ranks, const std::string& found) {
  FURROW_ASSERT(needed > 1, needed);
  std::string text = fmt::format(
      "this scenario needs {} ranks ({} rig, {} tire(s), {} terrain), but {} were started; start it with mpirun -n {} "
      "or srun -n {}",
      needed, 1, tires, terrain_ranks, world_size(), needed, needed);
  if (world_size() == 1 && !found.empty())
    text = fmt::format(
        "this scenario needs {} ranks ({} rig, {} tire(s), {} terrain), but was started as a single one: {}, with one "
        "start mpirun -n {}",
        needed, 1, tires, terrain_ranks, found, needed);
  return Error(ExitCode::bad_input, text);
}

}  // namespace

std::unique_ptr<Transport> make_mpi_transport(int* argc, char*** argv, int tire_count, int terrain_ranks) {
  // MPI ends with the process, not with the transport. A launcher ends all ranks as soon as one has ended with an
  // error, so no rank may end before the rank that informs the user has done so.
  const std::string found = launcher_text(launcher_variables());  // MPI sets them too once it has begun
  static MpiSession session(argc, argv);
  if (const int needed = 1 + tire_count + terrain_ranks; world_size() != needed)
    throw wrong_count(needed, tire_count, terrain_ranks, found);
  const int role = static_cast<int>(address_of(world_rank(), tire_count).role);
  std::vector<HostNode> host = gather_host_nodes(tire_count);
  return std::make_unique<NodeTransport>(std::make_unique<MpiWire>(session, role), tire_count, std::move(host));
}

std::vector<std::string> launcher_variables() {
  std::vector<std::string> found;
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* value = std::getenv(name); value && *value) found.emplace_back(name);
  return found;
}

bool launched_by_mpi() { return !launcher_variables().empty(); }

int launched_rank() {
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  if (begun && !ended) return world_rank();
  const std::vector<std::string> variables = launcher_variables();
  return variables.empty() ? 0 : std::max(0, std::atoi(std::getenv(variables.front().c_str())));
}

}  // namespace furrow
