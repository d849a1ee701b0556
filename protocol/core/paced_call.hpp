// Progress of loops whose rounds may take nanoseconds or seconds: reported, and stopped, within a tenth of a second.
#pragma once

#include "protocol/core/clock.hpp"
#include "protocol/core/progress_call.hpp"

namespace furrow {

class PacedCall {
 public:
  static constexpr double kInterval = 0.1;  // s of wall time between calls that are passed on

  /// @param call  may be empty; must outlive this
  /// @param quiet time in the beginning without any report, s
  explicit PacedCall(const ProgressCall& call, double quiet = 0.0) : call_(call), next_(wall_clock() + quiet) {}

  /// Passes a report on, unless one was passed on just before. May throw what the call throws.
  void operator()(const char* what, double share) {
    if (!call_) return;
    const double now = wall_clock();
    if (now < next_) return;
    next_ = now + kInterval;
    call_(what, share);
  }

 private:
  const ProgressCall& call_;
  double next_;  // wall time from which a call is passed on, s
};

}  // namespace furrow
