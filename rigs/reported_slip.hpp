// The two reported slips: relative to the spin, as rigs impose it, and relative to the speed.
#pragma once

#include <cmath>

namespace furrow::rigs {

inline constexpr double kSlipLimit = 1e6;  // replaces larger magnitudes if the wheel hardly turns

/// 1 − v/(ω r), within ±kSlipLimit; 0 for a wheel that neither rolls nor moves.
/// @param rolled ω r, m/s. @param speed v, m/s
inline double reported_slip(double rolled, double speed) {
  const double slid = rolled - speed;
  if (std::abs(slid) <= kSlipLimit * std::abs(rolled)) return rolled == 0.0 ? 0.0 : slid / rolled;
  return (slid > 0.0) == (rolled > 0.0) ? kSlipLimit : -kSlipLimit;
}

/// (ω r − v)/v, the longitudinal slip of ISO 8855:2011: −1 for a locked wheel. Within ±kSlipLimit, the value for a
/// wheel that spins on the spot; 0 for a wheel that neither rolls nor moves.
inline double reported_slip_ratio(double rolled, double speed) {
  const double slid = rolled - speed;
  if (std::abs(slid) <= kSlipLimit * std::abs(speed)) return speed == 0.0 ? 0.0 : slid / speed;
  return speed == 0.0 || (slid > 0.0) == (speed > 0.0) ? kSlipLimit : -kSlipLimit;
}

}  // namespace furrow::rigs
