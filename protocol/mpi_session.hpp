// Owners of MPI itself and of communicators.
#pragma once

#include <mpi.h>

#include "protocol/mpi_yield.hpp"

namespace furrow {

/// MPI from init to finalize. All MPI calls come from the thread that made this (MPI_THREAD_FUNNELED).
class MpiSession {
 public:
  MpiSession(int* argc, char*** argv);
  /// Waits for all ranks, as MPI_Finalize does; after expect_losses() only for a limited time.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  /// True if a receiver fetches large messages from the sender's memory on its own: Open MPI between processes of one
  /// machine, if the system allows it. Otherwise a message moves only while its sender is also inside MPI.
  bool receivers_pull() const { return receivers_pull_; }

  /// From here on ranks wait for messages in their own way, until they end.
  void ranks_are_set_up() noexcept;

  /// Some rank failed and others may be gone: exit with `exit_code` if MPI_Finalize takes longer than `patience` s.
  void expect_losses(double patience, int exit_code) noexcept;

 private:
  MpiYield yield_;
  bool receivers_pull_ = false;
  double patience_ = 0.0;  // s; 0: no limit
  int exit_code_ = 0;
};

int world_size();
int world_rank();

class Communicator {
 public:
  static Communicator duplicate(MPI_Comm of);
  static Communicator split(MPI_Comm of, int colour);
  /// The processes that share this machine's memory.
  static Communicator machine(MPI_Comm of);

  Communicator(Communicator&& other) noexcept;
  Communicator& operator=(Communicator&&) = delete;
  ~Communicator();

  MPI_Comm get() const { return comm_; }
  int size() const;

 private:
  explicit Communicator(MPI_Comm comm) : comm_(comm) {}
  MPI_Comm comm_;
};

}  // namespace furrow
