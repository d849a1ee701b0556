// Wall time of a run, step by step: `furrow run --profile` writes profile.json, a Chrome trace (chrome://tracing,
// ui.perfetto.dev) with one row per rank.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "protocol/core/clock.hpp"
#include "protocol/messages.hpp"

namespace furrow::output {

/// Of a run of that many steps every n-th one is recorded: at most about 4000.
std::int64_t recorded_every(std::int64_t steps);

/// One rank's record of its steps.
class StepProfile {
 public:
  /// @param steps of the run; 0: record nothing
  explicit StepProfile(std::int64_t steps);
  void begin(std::int64_t step) {  // synchronize begins
    begin_ = wall_clock();
    start(step, 0);
  }
  void exchanged(std::int64_t step) {
    exchanging_ += wall_clock() - begin_;
    start(step, 1);
  }
  void advanced(std::int64_t step) { start(step, 2); }
  /// Step number and the three times of each recorded step, s of wall_clock().
  const std::vector<double>& times() const { return times_; }
  /// Duration of all synchronizations, recorded or not, including waiting, s.
  double exchanging() const { return exchanging_; }

 private:
  void start(std::int64_t step, int part);
  std::int64_t every_ = 0;
  std::vector<double> times_;
  double begin_ = 0.0, exchanging_ = 0.0;  // s
};

/// @throws Error(io)
void write_profile(const std::filesystem::path& file, std::span<const FinalReport> reports);

}  // namespace furrow::output
