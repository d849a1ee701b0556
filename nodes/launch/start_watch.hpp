// Watches whether the ranks of a run start. Each reports that it has begun, that it has read the scenario, and that MPI
// connects it with the others. The launcher may hang before the first report, or MPI between the last two; reading may
// take as long as the files are large.
#pragma once

#include <cstddef>
#include <set>
#include <string>

#include "protocol/peer_clock.hpp"

namespace furrow::launch {

class StartWatch {
 public:
  /// @param patience  s without news
  StartWatch(std::size_t ranks, double patience) : ranks_(ranks), clock_(patience) {}

  void begun(int rank) { note(begun_, rank); }
  void read(int rank) { note(read_, rank); }
  void started(int rank) { note(started_, rank); }

  std::size_t count() const { return started_.size(); }
  bool all_started() const { return started_.size() == ranks_; }

  /// Returns true when there has been no news for too long. Call it at every poll; time during which this process
  /// itself was stopped does not count.
  bool too_late();
  /// "2 of 3 ranks began".
  std::string standing() const;

 private:
  void note(std::set<int>& stage, int rank) {
    stage.insert(rank);
    clock_.heard();
  }
  std::size_t ranks_;
  PeerClock clock_;
  std::set<int> begun_, read_, started_;
};

/// Time to wait for the ranks: FURROW_START_TIMEOUT, s, or 120.
/// @throws Error(bad_input) if the variable is not a number above zero
double start_patience();

}  // namespace furrow::launch
