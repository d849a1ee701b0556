// Imposed motions: a coordinate as a function of time, with its rate.
#pragma once

#include <functional>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {

/// Value (m or rad) and rate (m/s or rad/s) of an imposed coordinate at one instant.
struct Motion {
  double value = 0.0;
  double rate = 0.0;
};

using MotionFunction = std::function<Motion(double time)>;

/// Speed from rest to `speed` over `ramp` seconds by the C² smoothstep S(u) = 6u⁵ − 15u⁴ + 10u³, then
/// constant; the value is its integral, T (u⁶ − 3u⁵ + 5u⁴/2) during the ramp. ramp = 0: constant from t = 0. @pre ramp
/// ≥ 0
inline Motion ramped_motion(double time, double speed, double ramp) {
  FURROW_ASSERT(ramp >= 0.0, ramp);
  if (time < ramp) {
    const double u = time > 0.0 ? time / ramp : 0.0;
    return {speed * ramp * u * u * u * u * (2.5 + u * (u - 3.0)), speed * u * u * u * (10.0 + u * (6.0 * u - 15.0))};
  }
  return {speed * (time - 0.5 * ramp), speed};
}

/// Value from 0 at time 0 to `change` after `duration` seconds by the smoothstep S.
inline Motion step_motion(double time, double change, double duration) {
  FURROW_ASSERT(duration >= 0.0, duration);
  if (!(time > 0.0)) return {};
  if (time >= duration) return {change, 0.0};
  const double u = time / duration;
  return {change * u * u * u * (10.0 + u * (6.0 * u - 15.0)), change / duration * 30.0 * u * u * (1.0 - u) * (1.0 - u)};
}

}  // namespace furrow::vehicle
