// When checkpoints are due by wall time: soon after a run begins, so that a run of minutes can be continued, then
// after twice the time each, until their interval is reached. No result depends on it.
#pragma once

#include <algorithm>

namespace furrow::checkpoint {

inline constexpr double kFirstWallInterval = 30.0;  // s

struct WallSchedule {
  double interval = 0.0;             // s; 0: none for this reason
  double last = 0.0;                 // wall time of the last one, or of the beginning, s
  double wait = kFirstWallInterval;  // until the next one, at most, s

  bool due(double now) const { return interval > 0.0 && now - last >= std::min(wait, interval); }
  /// One is written, for this reason or another.
  void written(double now) {
    if (due(now)) wait = 2.0 * std::min(wait, interval);
    last = now;
  }
};

}  // namespace furrow::checkpoint
