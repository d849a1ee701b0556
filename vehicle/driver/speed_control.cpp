#include "vehicle/driver/speed_control.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kFrequency = 0.5;  // ω of the gains from the vehicle, rad/s
constexpr double kDamping = 1.0;    // ζ

}  // namespace

Table table_of_time(const std::string& name, DriverPoints points) {
  if (points.empty()) points.emplace_back(0.0, 0.0);
  if (points.size() == 1) points.emplace_back(points.front().first + 1.0, points.front().second);
  return Table(name, std::move(points), TableCurve::linear, TableEnd::constant);
}

SpeedControl::SpeedControl(const SpeedSpec& spec, const DriverCar& car)
    : target_(table_of_time("target", spec.target)),
      proportional_(spec.proportional),
      integral_(spec.integral),
      hysteresis_(spec.hysteresis),
      stop_speed_(spec.stop_speed),
      brake_ratio_(car.brake_force / car.drive_force) {
  const double time_at_full_throttle = car.mass / car.drive_force;  // for 1 m/s, s²/m
  if (proportional_ < 0.0) proportional_ = 2.0 * kDamping * kFrequency * time_at_full_throttle;
  if (integral_ < 0.0) integral_ = kFrequency * kFrequency * time_at_full_throttle;
}

// The integral follows the trapezoidal rule over the times of the calls.
void SpeedControl::press(double time, double speed, SpeedState& s, DriverInputs& inputs) const {
  const double wanted = target(time), error = wanted - speed;
  const double step = s.begun ? time - s.time : 0.0;
  FURROW_ASSERT(step >= 0.0, time, s.time);
  const double growth = integral_ * 0.5 * (s.error + error) * step;
  const double demand = proportional_ * error + s.integral + growth;
  const bool winds_up = (demand > 1.0 && growth > 0.0) || (demand < -brake_ratio_ && growth < 0.0);
  if (!winds_up) s.integral += growth;
  s.begun = true;
  s.time = time;
  s.error = error;
  if (wanted > 0.0) s.stopped = false;
  if (wanted <= 0.0 && std::abs(speed) < stop_speed_) s.stopped = true;
  if (s.stopped) {
    s.integral = 0.0;
    s.braking = true;
    inputs.throttle = 0.0;
    inputs.brake = 1.0;
    return;
  }
  split(std::clamp(proportional_ * error + s.integral, -brake_ratio_, 1.0), s, inputs);
}

void SpeedControl::split(double demand, SpeedState& s, DriverInputs& inputs) const {
  if (demand < -hysteresis_) s.braking = true;
  if (demand > hysteresis_) s.braking = false;
  inputs.throttle = s.braking ? 0.0 : std::max(demand, 0.0);
  inputs.brake = s.braking ? std::max(-demand, 0.0) / brake_ratio_ : 0.0;
}

}  // namespace furrow::vehicle
