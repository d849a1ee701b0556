// What the user sees while a run is under way.
#pragma once

#include <functional>
#include <string>

namespace furrow {

struct Progress {
  std::string phase;          // "settling", "running", …
  double share = 0.0;         // of the phase, 0…1
  double time = 0.0;          // simulated, s
  double end = 0.0;           // s
  double pull = 0.0;          // N
  double sinkage = 0.0;       // m
  double speed = 0.0;         // m/s
  double eta = -1.0;          // wall seconds left; negative: unknown
};

using ProgressSink = std::function<void(const Progress&)>;

}  // namespace furrow
