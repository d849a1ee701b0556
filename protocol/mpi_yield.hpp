// Whether a rank that waits inside Open MPI leaves its core to others.
//
// Ranks wait for each other in collective calls while they are set up and while they end. If there are more ranks
// than cores, a rank that spins there takes time from the one that it waits for (scripts/docs/coupling.md has the
// figures). During a run the opposite holds: a rank sleeps between its looks for messages, and one that yields on a
// busy machine waits until all others have had their time.
//
// Open MPI decides this once, when it begins, by OMPI_MCA_mpi_yield_when_idle. The function that changes it later is
// not part of MPI, so it is looked up in the loaded libraries; without it ranks never yield. A value that is set
// already is kept: it comes from the user, or from the supervisor for ranks that poll inside an engine.
#pragma once

namespace furrow {

class MpiYield {
 public:
  /// Call it before MPI begins.
  MpiYield();
  void set(bool yields) noexcept;

 private:
  using Switch = bool (*)(bool);
  Switch switch_ = nullptr;  // null if nothing can be changed, or must not be
  bool never_ = false;       // chosen by the user
};

}  // namespace furrow
