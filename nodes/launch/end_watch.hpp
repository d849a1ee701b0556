// Whether the launcher ends once its ranks have. Open MPI 4.1 may not: where ranks leave it as it shuts down, two of
// its threads wait for each other for ever.
#pragma once

#include <cstddef>
#include <map>

#include "protocol/core/error.hpp"
#include "protocol/peer_clock.hpp"

namespace furrow::launch {

class EndWatch {
 public:
  /// @param end_patience      s that the launcher has to end once all its ranks have
  /// @param failure_patience  s that the ranks and the launcher have to end after one rank has failed
  EndWatch(std::size_t ranks, double end_patience, double failure_patience);

  /// A rank has left MPI and ends with this code.
  void ended(int rank, ExitCode code) { codes_[rank] = code; }
  /// A rank failed or was lost: the launcher ends the others.
  void failed() { failed_ = true; }

  bool all_ended() const { return codes_.size() == ranks_; }
  /// Of the ranks that have ended: the first that is not `done`, by number of the rank.
  ExitCode code() const;

  /// True once the launcher, a process of this machine, has had long enough to end; to be asked at every poll. Time
  /// during which this process itself was stopped does not count.
  bool too_late(int launcher);

 private:
  std::size_t ranks_;
  double end_patience_, failure_patience_, patience_;  // patience_: for what is known at the moment, s
  std::map<int, ExitCode> codes_;
  bool failed_ = false;
  PeerClock clock_;
};

}  // namespace furrow::launch
