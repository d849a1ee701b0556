// Controls of rows in speeds, for the tests of shafts and drivelines.
#pragma once

#include "vehicle/multibody/rate_row.hpp"

namespace furrow::testing {

/// A row with the torque `value`, N m.
inline vehicle::RateControl torque(double value) {
  vehicle::RateControl control;
  control.mode = vehicle::RateMode::torque;
  control.torque = value;
  return control;
}

/// A row that is held at `speed`, rad/s.
inline vehicle::RateControl held(double speed) {
  vehicle::RateControl control;
  control.mode = vehicle::RateMode::hold;
  control.target = speed;
  return control;
}

}  // namespace furrow::testing
