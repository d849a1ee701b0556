#include "rigs/vehicle/vehicle_driving.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::rigs {

using vehicle::Selector;
namespace gear_request = vehicle::gear_request;

vehicle::VehicleInputs vehicle_inputs(const vehicle::DriverInputs& inputs) {
  FURROW_ASSERT(inputs.gear >= gear_request::automatic, inputs.gear);
  vehicle::VehicleInputs to;
  to.throttle = inputs.throttle;
  to.brake = inputs.brake;
  to.steering = inputs.steering;
  if (inputs.gear == gear_request::reverse) to.selector = Selector::reverse;
  if (inputs.gear == gear_request::neutral) to.selector = Selector::neutral;
  to.gear = std::max(0, inputs.gear);
  to.lock = inputs.lock;
  return to;
}

vehicle::DriverView driver_view(const vehicle::Vehicle& vehicle, const Vec3& seat) {
  const vehicle::Body& chassis = vehicle.system().body(vehicle.chassis());
  vehicle::DriverView view;
  view.time = vehicle.system().time();
  view.position = vehicle.origin() + chassis.R * seat;
  view.velocity =
      chassis.state.velocity + chassis.state.angular_velocity.cross(Vec3(view.position - chassis.state.position));
  view.yaw = yaw_of(vehicle);
  view.yaw_rate = chassis.state.angular_velocity.z();
  return view;
}

int gear_of(const vehicle::Vehicle& vehicle, const vehicle::DriverInputs& inputs) {
  const std::optional<vehicle::Gearbox>& gearbox = vehicle.drive().gearbox();
  if (!gearbox) return inputs.gear == gear_request::automatic ? 1 : inputs.gear;
  if (gearbox->gear() == vehicle::kNeutral) return gear_request::neutral;
  const int forward = static_cast<int>(vehicle.spec().driveline.gearbox->ratios.size());
  return gearbox->gear() == forward ? gear_request::reverse : gearbox->gear() + 1;
}

double yaw_of(const vehicle::Vehicle& vehicle) {
  const Mat3& R = vehicle.system().body(vehicle.chassis()).R;
  return std::atan2(R(1, 0), R(0, 0));
}

}  // namespace furrow::rigs
