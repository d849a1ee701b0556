#include "vehicle/analysis/quarter_car.hpp"

#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {

QuarterCarResponse quarter_car_response(const QuarterCarParams& car, double omega) {
  FURROW_ASSERT(car.body_mass > 0.0 && car.wheel_mass > 0.0 && car.tire_stiffness > 0.0, car.body_mass, car.wheel_mass,
                car.tire_stiffness);
  const std::complex<double> z(car.stiffness, omega * car.damping), tire(car.tire_stiffness, omega * car.tire_damping);
  const std::complex<double> body = z - omega * omega * car.body_mass;
  const std::complex<double> d = (z + tire - omega * omega * car.wheel_mass) * body - z * z;
  QuarterCarResponse response;
  response.wheel = tire * body / d;
  response.body = tire * z / d;
  response.tire_force = tire * (1.0 - response.wheel);
  return response;
}

double usual_stiffness(double body_mass) {
  const double omega = 2.0 * std::numbers::pi * kUsualBodyFrequency;
  return body_mass * omega * omega;
}

double usual_damping(double body_mass, double stiffness) {
  return 2.0 * kUsualBodyDamping * std::sqrt(body_mass * stiffness);
}

}  // namespace furrow::vehicle
