// End of an iteration that cannot reach its tolerance because of round-off.
#pragma once

namespace furrow::tire {

class RoundOffEnd {
 public:
  /// @param enough largest residual that needs no further step
  /// @param near whether all residuals are within round-off
  /// @returns whether the iteration is over: it is near, and its residual is small enough or its last step, from near,
  /// gained nothing
  bool reached(double residual, double enough, bool near) {
    const bool stalled = was_near_ && residual > kGain * before_;
    was_near_ = near, before_ = residual;
    return near && (residual <= enough || stalled);
  }

 private:
  static constexpr double kGain = 0.5;  // a step that leaves more than this share of the residual gains nothing
  bool was_near_ = false;
  double before_ = 0.0;
};

}  // namespace furrow::tire
