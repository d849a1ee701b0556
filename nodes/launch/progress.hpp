// Progress of a run as the user sees it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "protocol/core/progress_call.hpp"

namespace furrow::launch {

struct Progress {
  std::string phase;      // "settling", "running", …
  double share = 0.0;     // of the phase, 0…1
  double time = 0.0;      // simulated, s
  double end = 0.0;       // s
  double pull = 0.0;      // N; NaN: the rig measures none
  double sinkage = 0.0;   // of the wheel that has sunk most, m
  double speed = 0.0;     // m/s
  double eta = -1.0;      // wall seconds left; negative: unknown
  std::string note = {};  // an addition from the rig: "gear 2"
};

using ProgressSink = std::function<void(const Progress&)>;

/// "t 0.512 of 1.5 s   1:23 left   pull 1432 N   sinkage 31 mm   1.40 m/s".
std::string progress_text(const Progress& progress);

/// Share of the run in a line of progress_text(); NaN for other lines and for other phases than "running".
double share_in(std::string_view line);

/// Estimates the time left of a phase that reports only its share, from the progress since it began.
class PhaseClock {
 public:
  /// @param now wall time, s @returns s; -1 if there was no progress since the phase began
  double time_left(const std::string& phase, double share, double now);

 private:
  std::string phase_;
  double begin_ = 0.0;        // wall time, s
  double begin_share_ = 0.0;  // of the phase, at that time
};

/// Draws on standard error: one live line on a terminal, otherwise a line every few seconds. Draws nothing if messages
/// are silenced (messages.hpp).
class ProgressDisplay {
 public:
  ProgressDisplay();
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);
  /// Prints a line that stays.
  void say(const std::string& text);
  /// Prints a line that stays, even if messages are silenced.
  void say_error(const std::string& text);
  void clear();

 private:
  bool terminal_;
  bool drawn_ = false;
  double last_ = -1e300;  // wall time of the last line, s
  std::string phase_;
  PhaseClock clock_;
};

/// Shows on `display` the progress of long work, and ends the work when a signal asks for a stop.
/// @param when end of the message: " during {}", in which {} is replaced by the kind of work
/// @throws Error(stopped) out of the call
ProgressCall shown_on(ProgressDisplay& display, const std::string& when);

}  // namespace furrow::launch
