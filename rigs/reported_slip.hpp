// The slips that are reported: against the spin, as rigs impose it, and against the speed.
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

/// (ω r − v)/v, the longitudinal slip of ISO 8855:2011: −1 of a locked wheel. Within ±kSlipLimit, which a wheel has
/// that spins on the spot; 0 for a wheel that neither rolls nor moves.
inline double reported_slip_ratio(double rolled, double speed) {
  const double slid = rolled - speed;
  if (std::abs(slid) <= kSlipLimit * std::abs(speed)) return speed == 0.0 ? 0.0 : slid / speed;
  return speed == 0.0 || (slid > 0.0) == (speed > 0.0) ? kSlipLimit : -kSlipLimit;
}

}  // namespace furrow::rigs
