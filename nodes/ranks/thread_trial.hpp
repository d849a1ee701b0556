// Which of two numbers of threads lets the whole run step faster, where the terrain's threads share cores with other
// ranks: blocks of steps with either are timed in turn, now and then, as the share of the others changes. The bits of
// results do not depend on the choice.
#pragma once

namespace furrow::ranks {

class ThreadTrial {
 public:
  /// @param other  0: there is nothing to choose
  explicit ThreadTrial(int first, int other = 0) : threads_{first, other} {}

  /// The number of threads for the next step.
  int now() const { return threads_[used_]; }

  /// @param wall  time that the last step took, from one begin to the next, s
  void step_took(double wall);

 private:
  int threads_[2];
  int used_ = 0, kept_ = 0;          // of threads_: in the next step; between trials
  int steps_ = 0, blocks_ = 0;       // of the current block; of the current trial
  int pause_ = kFirstPause;          // blocks before the next trial
  double sum_ = 0.0, best_[2] = {};  // s: of the current block; the faster block of each number

  static constexpr int kFirstPause = 8;
};

}  // namespace furrow::ranks
