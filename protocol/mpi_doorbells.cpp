#include "protocol/mpi_doorbells.hpp"

#include <memory>
#include <new>
#include <numeric>

#include "protocol/core/assert.hpp"
#include "protocol/mpi_session.hpp"

namespace furrow {
namespace {

constexpr std::size_t kRoom = sizeof(Doorbell) + alignof(Doorbell);

/// The first place for a doorbell in a rank's part. It is the same for all, because pages are aligned alike everywhere.
void* place_in(void* part) {
  std::size_t room = kRoom;
  return std::align(alignof(Doorbell), sizeof(Doorbell), part, room);
}

}  // namespace

MpiDoorbells::MpiDoorbells(MPI_Comm comm) {
  const Communicator machine = Communicator::machine(comm);
  int ranks = 0;
  MPI_Comm_size(comm, &ranks);
  of_rank_.assign(static_cast<std::size_t>(ranks), nullptr);

  MPI_Comm_set_errhandler(machine.get(), MPI_ERRORS_RETURN);  // no shared memory: no doorbells
  void* memory = nullptr;
  MPI_Win window = MPI_WIN_NULL;
  int made = MPI_Win_allocate_shared(kRoom, 1, MPI_INFO_NULL, machine.get(), &memory, &window) == MPI_SUCCESS;
  MPI_Allreduce(MPI_IN_PLACE, &made, 1, MPI_INT, MPI_MIN, machine.get());
  if (made) {
    own_ = new (place_in(memory)) Doorbell;
    MPI_Barrier(machine.get());  // nobody rings a bell before it exists
    // For each rank of `machine`, its rank in `comm`.
    std::vector<int> here(static_cast<std::size_t>(machine.size())), there(here.size());
    std::iota(here.begin(), here.end(), 0);
    MPI_Group of_machine, of_all;
    MPI_Comm_group(machine.get(), &of_machine);
    MPI_Comm_group(comm, &of_all);
    MPI_Group_translate_ranks(of_machine, machine.size(), here.data(), of_all, there.data());
    MPI_Group_free(&of_machine);
    MPI_Group_free(&of_all);
    for (const int rank : here) {
      MPI_Aint size = 0;
      int unit = 0;
      void* bell = nullptr;
      MPI_Win_shared_query(window, rank, &size, &unit, &bell);
      of_rank_[static_cast<std::size_t>(there[static_cast<std::size_t>(rank)])] =
          static_cast<Doorbell*>(place_in(bell));
    }
  }
  int all = made && machine.size() == ranks;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm);
  everyone_ = all != 0;
}

void MpiDoorbells::ring(int rank) noexcept {
  FURROW_ASSERT(in_range(rank, of_rank_.size()), rank, of_rank_.size());
  if (Doorbell* bell = of_rank_[static_cast<std::size_t>(rank)]) bell->ring();
}

}  // namespace furrow
