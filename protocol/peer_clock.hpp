// How long a node has waited for a peer, counting only time during which this process itself ran. A stopped terminal, a
// debugger or a sleeping laptop adds one capped interval, not its whole length.
#pragma once

#include <algorithm>

#include "protocol/core/clock.hpp"

namespace furrow {

class PeerClock {
 public:
  explicit PeerClock(double timeout) : timeout_(timeout), begin_(wall_clock()), last_(begin_) {}

  /// A sign of life from the peer: the time-out starts again.
  void heard() { silent_ = 0.0; }
  /// Call it at every poll.
  bool expired() {
    const double at = wall_clock();
    silent_ += std::min(at - last_, kMaxGap);
    last_ = at;
    return silent_ > timeout_;
  }
  /// Silence counted so far, s.
  double silent() const { return silent_; }
  /// Wall time since construction, s.
  double total() const { return wall_clock() - begin_; }

 private:
  static constexpr double kMaxGap = 0.25;  // s, counted at most for one poll
  double timeout_, begin_, last_;
  double silent_ = 0.0;
};

}  // namespace furrow
