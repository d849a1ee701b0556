// How long a node has waited for a peer, counting only time during which this process itself ran: a stopped
// terminal, a debugger or a sleeping laptop adds one capped interval, not its whole length.
#pragma once

#include <algorithm>
#include <chrono>

namespace furrow {

class PeerClock {
 public:
  explicit PeerClock(double timeout) : timeout_(timeout), begin_(now()), last_(begin_) {}

  /// A sign of life from the peer: the time-out starts again.
  void heard() { silent_ = 0.0; }
  /// To be asked at every poll.
  bool expired() {
    const double at = now();
    silent_ += std::min(at - last_, kMaxGap);
    last_ = at;
    return silent_ > timeout_;
  }
  /// Silence counted so far, s.
  double silent() const { return silent_; }
  /// Wall time since construction, s.
  double total() const { return now() - begin_; }

  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

 private:
  static constexpr double kMaxGap = 0.25;  // s, counted for one poll at most
  double timeout_, begin_, last_;
  double silent_ = 0.0;
};

}  // namespace furrow
