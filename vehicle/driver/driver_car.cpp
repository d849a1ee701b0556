#include "vehicle/driver/driver_car.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "vehicle/analysis/kinematics.hpp"
#include "vehicle/spec/shaft_speeds.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kGrip = 0.8;           // of the weight, along the ground
constexpr double kNoLock = 1.0;         // rad, of vehicles that cannot steer: not used
constexpr double kSmallTravel = 0.002;  // m: the steered wheels are near their drawn height
constexpr int kPostures = 3;            // of each motion: −1, 0 and 1

double axle_x(const AxleSpec& axle) {
  return 0.5 * (spindle_of(axle.corners[kLeft].suspension).center.x() +
                spindle_of(axle.corners[kRight].suspension).center.x());
}

int foremost(const VehicleSpec& spec, bool steered) {
  int found = -1;
  for (int k = 0; k < static_cast<int>(spec.axles.size()); ++k)
    if ((!steered || spec.axles[k].steering) && (found < 0 || axle_x(spec.axles[k]) > axle_x(spec.axles[found])))
      found = k;
  return found;
}

double track(const VehicleSpec& spec) {
  double widest = 0.0;
  for (const AxleSpec& axle : spec.axles)
    widest = std::max(widest, spindle_of(axle.corners[kLeft].suspension).center.y() -
                                  spindle_of(axle.corners[kRight].suspension).center.y());
  return widest;
}

double steering_lock(const VehicleSpec& spec, std::span<const double> radii, double wheelbase) {
  double sum = 0.0;
  int count = 0;
  if (foremost(spec, true) >= 0)
    for (const KinematicsRow& row : kinematics(spec, radii, {kSmallTravel, kPostures}))
      if (row.motion == "steering" && row.steering == 1.0) {
        sum += std::abs(row.steer);
        ++count;
      }
  if (count > 0) return sum / count;
  if (spec.driveline.skid_steer == 0.0) return kNoLock;
  return std::atan(2.0 * std::abs(spec.driveline.skid_steer) * wheelbase / track(spec));
}

double engine_force(const VehicleSpec& spec, double radius) {
  const DrivelineSpec& line = spec.driveline;
  if (!line.engine || line.wheels.empty()) return 0.0;
  double torque = 0.0;
  for (const auto& [rpm, one] : line.engine->torque) torque = std::max(torque, one);
  if (line.converter) torque *= line.converter->torque_ratio.front().second;
  const std::vector<double> speeds = shaft_speeds(line, 0);
  double ratio = 0.0;
  for (const WheelShaftSpec& wheel : line.wheels) ratio = std::max(ratio, std::abs(speeds[line.shaft(wheel.shaft)]));
  return ratio > 0.0 ? torque / ratio / radius : 0.0;
}

double motor_force(const VehicleSpec& spec, double radius) {
  double torque = 0.0;
  for (const MotorSpec& motor : spec.driveline.motors) torque += 2.0 * motor.stall_torque * std::abs(motor.gear_ratio);
  return torque / radius;
}

double brake_force(const VehicleSpec& spec, double radius) {
  double torque = 0.0;
  for (const AxleSpec& axle : spec.axles)
    for (const CornerSpec& corner : axle.corners)
      if (corner.brake) torque += corner.brake->torque;
  return torque / radius;
}

}  // namespace

int rear_axle(const VehicleSpec& spec) {
  FURROW_ASSERT(!spec.axles.empty(), spec.file);
  int found = 0;
  for (int k = 1; k < static_cast<int>(spec.axles.size()); ++k)
    if (axle_x(spec.axles[k]) < axle_x(spec.axles[found])) found = k;
  return found;
}

Vec3 rear_axle_middle(const VehicleSpec& spec) {
  const AxleSpec& axle = spec.axles[rear_axle(spec)];
  return 0.5 * (spindle_of(axle.corners[kLeft].suspension).center + spindle_of(axle.corners[kRight].suspension).center);
}

bool can_steer(const VehicleSpec& spec) { return spec.driveline.skid_steer != 0.0 || foremost(spec, true) >= 0; }

bool can_follow(const VehicleSpec& spec) {
  const int front = foremost(spec, true);
  return spec.driveline.skid_steer != 0.0 || (front >= 0 && axle_x(spec.axles[front]) > rear_axle_middle(spec).x());
}

bool can_brake(const VehicleSpec& spec) { return brake_force(spec, 1.0) > 0.0; }

bool can_drive(const VehicleSpec& spec) { return engine_force(spec, 1.0) + motor_force(spec, 1.0) > 0.0; }

bool can_lock(const VehicleSpec& spec) {
  return std::ranges::any_of(spec.driveline.differentials, [](const auto& one) { return one.lock_torque.has_value(); });
}

DriverCar driver_car(const VehicleSpec& spec, std::span<const double> radii, double tire_width, double mass) {
  FURROW_ASSERT(radii.size() == 2 * spec.axles.size(), radii.size(), spec.axles.size());
  FURROW_ASSERT(mass > 0.0 && tire_width >= 0.0, mass, tire_width);
  const double radius = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
  const int front = foremost(spec, true) >= 0 ? foremost(spec, true) : foremost(spec, false);
  const double grip = kGrip * mass * kStandardGravity, base = axle_x(spec.axles[front]) - rear_axle_middle(spec).x();
  const auto at_most_grip = [&](double force) { return force > 0.0 ? std::min(force, grip) : grip; };
  DriverCar car;
  car.wheelbase = std::max(base, radius);
  car.steering_lock = steering_lock(spec, radii, car.wheelbase);
  car.width = track(spec) + tire_width;
  car.mass = mass;
  car.drive_force = at_most_grip(std::max(engine_force(spec, radius), motor_force(spec, radius)));
  car.brake_force = at_most_grip(std::max(brake_force(spec, radius), motor_force(spec, radius)));
  return car;
}

}  // namespace furrow::vehicle
