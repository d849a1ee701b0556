#include "protocol/mpi_transport.hpp"

#include <mpi.h>

#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/mpi_session.hpp"
#include "protocol/mpi_wire.hpp"
#include "protocol/node_transport.hpp"

namespace furrow {
namespace {

Address address_of(int rank, int tires) {
  FURROW_ASSERT(rank >= 0 && tires >= 0, rank, tires);
  if (rank == 0) return {Role::rig, 0};
  if (rank <= tires) return {Role::tire, rank - 1};
  return {Role::terrain, 0};
}

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

}  // namespace

std::unique_ptr<Transport> make_mpi_transport(int* argc, char*** argv, int tire_count, int terrain_ranks) {
  // MPI ends with the process, not with the transport: a launcher ends all ranks as soon as one has ended with an
  // error, so none may end before the one that tells the user has done so.
  static MpiSession session(argc, argv);
  const int needed = 1 + tire_count + terrain_ranks, given = world_size();
  if (given != needed)
    throw Error(
        ExitCode::bad_input,
        fmt::format("this scenario needs {} ranks ({} rig, {} tire(s), {} terrain), but mpirun started {}; "
                    "start it with mpirun -n {}",
                    needed, 1, tire_count, terrain_ranks, given, needed));
  const int role = static_cast<int>(address_of(world_rank(), tire_count).role);
  std::vector<HostNode> host = gather_host_nodes(tire_count);
  return std::make_unique<NodeTransport>(std::make_unique<MpiWire>(session, role), tire_count,
                                         std::move(host));
}

int role_communicator(const Transport& transport) {
  const auto* node = dynamic_cast<const NodeTransport*>(&transport);
  const auto* wire = node ? dynamic_cast<const MpiWire*>(&node->wire()) : nullptr;
  if (!wire) throw Error(ExitCode::bad_input, "this run has no MPI communicators");
  return MPI_Comm_c2f(wire->role().get());
}

bool launched_by_mpi() {
  return std::getenv("OMPI_COMM_WORLD_RANK") || std::getenv("PMIX_RANK") || std::getenv("PMI_RANK");
}

int launched_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* value = std::getenv(name)) return std::atoi(value);
  return 0;
}

}  // namespace furrow
