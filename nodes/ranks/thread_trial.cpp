#include "nodes/ranks/thread_trial.hpp"

#include <algorithm>
#include <limits>

#include "protocol/core/assert.hpp"

namespace furrow::ranks {
namespace {

constexpr int kBlock = 100;     // steps
constexpr int kOfTrial = 4;     // blocks: the kept number and the other, twice
constexpr int kPause = 60;      // blocks
constexpr double kGain = 0.97;  // of the time: below it the other number is kept

}  // namespace

void ThreadTrial::step_took(double wall) {
  FURROW_ASSERT(wall >= 0.0, wall);
  if (threads_[1] == 0) return;
  sum_ += wall;
  if (++steps_ < kBlock) return;
  const double block = sum_;
  steps_ = 0, sum_ = 0.0;
  if (pause_ > 0) {
    if (--pause_ == 0) best_[0] = best_[1] = std::numeric_limits<double>::infinity();
    return;
  }
  best_[used_] = std::min(best_[used_], block);
  used_ = 1 - used_;
  if (++blocks_ < kOfTrial) return;
  if (best_[1 - kept_] < kGain * best_[kept_]) kept_ = 1 - kept_;
  used_ = kept_, blocks_ = 0, pause_ = kPause;
}

}  // namespace furrow::ranks
