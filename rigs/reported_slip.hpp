// The slip that rigs report.
#pragma once

#include <cmath>

namespace furrow::rigs {

inline constexpr double kSlipLimit = 1e6;  // reported instead of larger magnitudes when the wheel hardly turns

/// 1 − v/(ω r), within ±kSlipLimit; 0 for a wheel that neither rolls nor moves.
/// @param rolled ω r, m/s. @param speed v, m/s
inline double reported_slip(double rolled, double speed) {
  const double slid = rolled - speed;
  if (std::abs(slid) <= kSlipLimit * std::abs(rolled)) return rolled == 0.0 ? 0.0 : slid / rolled;
  return (slid > 0.0) == (rolled > 0.0) ? kSlipLimit : -kSlipLimit;
}

}  // namespace furrow::rigs
