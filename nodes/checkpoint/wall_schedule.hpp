// Checkpoints by wall time. The first is due soon after a run begins, so that a run of minutes can be continued; the
// time between them then doubles up to their interval. No result depends on it.
#pragma once

#include <algorithm>

namespace furrow::checkpoint {

inline constexpr double kFirstWallInterval = 30.0;  // s

struct WallSchedule {
  double interval = 0.0;             // s; 0: none by wall time
  double last = 0.0;                 // wall time of the last one, or of the beginning, s
  double wait = kFirstWallInterval;  // until the next one, at most, s

  bool due(double now) const { return interval > 0.0 && now - last >= std::min(wait, interval); }
  /// Notes that a checkpoint was written, for any reason.
  void written(double now) {
    if (due(now)) wait = 2.0 * std::min(wait, interval);
    last = now;
  }
};

}  // namespace furrow::checkpoint
