// What the user sees while a run is under way.
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
  std::string note = {};  // what else the rig says: "gear 2"
};

using ProgressSink = std::function<void(const Progress&)>;

/// "t 0.512 of 1.5 s   1:23 left   pull 1432 N   sinkage 31 mm   1.40 m/s".
std::string progress_text(const Progress& progress);

/// Share of the run in a line of progress_text(); NaN: it is no such line, or not of the phase "running".
double share_in(std::string_view line);

/// Estimates how long a phase still takes that states its share alone: what was done since it began, scaled.
class PhaseClock {
 public:
  /// @param now wall time, s @returns s; -1 where nothing has been done since the phase began
  double time_left(const std::string& phase, double share, double now);

 private:
  std::string phase_;
  double begin_ = 0.0;        // wall time, s
  double begin_share_ = 0.0;  // of the phase, at that time
};

/// Draws on standard error: one live line on a terminal, otherwise a line every few seconds. Where messages are
/// silenced (messages.hpp) it draws nothing.
class ProgressDisplay {
 public:
  ProgressDisplay();
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);
  /// A line that stays.
  void say(const std::string& text);
  /// A line that stays even where messages are silenced.
  void say_error(const std::string& text);
  /// Removes the live line.
  void clear();

 private:
  bool terminal_;
  bool drawn_ = false;
  double last_ = -1e300;  // wall time of the last line, s
  std::string phase_;
  PhaseClock clock_;
};

/// Shows on `display` what long work reports of itself, and ends the work when a signal asks for a stop.
/// @param when of the message: " during {}", in which {} stands for what is done
/// @throws Error(stopped) out of the call
ProgressCall shown_on(ProgressDisplay& display, const std::string& when);

}  // namespace furrow::launch
