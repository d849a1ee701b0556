// Watches whether the launcher ends after its ranks. Open MPI 4.1 may not: if ranks leave it while it shuts down, two
// of its threads wait for each other forever.
#pragma once

#include <cstddef>
#include <map>

#include "protocol/core/error.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow::launch {

class EndWatch {
 public:
  /// @param end_patience      s that the launcher has to end after all its ranks
  /// @param failure_patience  s that the ranks and the launcher have to end after one rank has failed
  EndWatch(std::size_t ranks, double end_patience, double failure_patience);

  /// Notes that a rank has left MPI and ends with this code.
  void ended(int rank, ExitCode code) { codes_[rank] = code; }
  /// Notes that a rank failed or was lost: the launcher ends the others.
  void failed() { failed_ = true; }

  bool all_ended() const { return codes_.size() == ranks_; }
  /// Returns the first code that is not `done` among the ended ranks, by rank number.
  ExitCode code() const;

  /// Returns true when the launcher, a process of this machine, has had long enough to end. Call it at every poll; time
  /// during which this process itself was stopped does not count.
  bool too_late(int launcher);

 private:
  std::size_t ranks_;
  double end_patience_, failure_patience_, patience_;  // patience_: the present one, s
  std::map<int, ExitCode> codes_;
  bool failed_ = false;
  PeerClock clock_;
};

}  // namespace furrow::launch
