// The doorbells of all ranks on this machine, in a window of shared memory from MPI.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <vector>

#include "protocol/doorbell.hpp"

namespace furrow {

class MpiDoorbells {
 public:
  /// Collective over `comm`. If the system grants no shared memory, there are no doorbells, and nobody can end a sleep
  /// early. The window lives as long as MPI: freeing it would mean waiting for ranks that may be lost.
  explicit MpiDoorbells(MPI_Comm comm);
  MpiDoorbells(const MpiDoorbells&) = delete;
  MpiDoorbells& operator=(const MpiDoorbells&) = delete;

  /// Whether every rank has a doorbell that this rank can ring, and can ring this rank's.
  bool everyone() const { return everyone_; }
  /// Does nothing for a rank on another machine.
  void ring(int rank) noexcept;
  std::uint32_t own_count() const noexcept { return own_->count(); }
  void sleep(std::uint32_t heard, double longest) noexcept { own_->sleep(heard, longest); }

 private:
  Doorbell alone_;  // where there is no window
  Doorbell* own_ = &alone_;
  std::vector<Doorbell*> of_rank_;  // null: on another machine
  bool everyone_ = false;
};

}  // namespace furrow
