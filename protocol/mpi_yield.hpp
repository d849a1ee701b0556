// Whether a rank that waits inside Open MPI leaves its core to others meanwhile.
//
// While ranks are set up and while they end they wait for each other in collective calls. Where they outnumber the
// cores, one that spins there takes the time of the one that it waits for (figures in protocol/README.md). In a run the
// opposite holds: a rank sleeps between its looks for messages, and who yields on a busy machine waits until all others
// have had their time.
//
// Open MPI decides this once, when it begins, by OMPI_MCA_mpi_yield_when_idle. What changes it later is no part of MPI,
// so it is looked for among the loaded libraries; where it is missing ranks never yield. A value that the environment
// holds already is the user's, or the supervisor's for ranks that poll inside an engine: it stays.
#pragma once

namespace furrow {

class MpiYield {
 public:
  /// Before MPI begins.
  MpiYield();
  void set(bool yields) noexcept;

 private:
  using Switch = bool (*)(bool);
  Switch switch_ = nullptr;  // null where nothing can be changed, or must not be
};

}  // namespace furrow
