#include "rigs/vehicle/vehicle_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "rigs/vehicle/vehicle_driving.hpp"
#include "vehicle/parts/vehicle_energy.hpp"

namespace furrow::rigs {

MotionBefore MotionBefore::of(const vehicle::Vehicle& car) {
  return {car.origin(), car.system().momentum(), car.drive().work(car.system())};
}

void begin_driveline(VehicleRow& row) { row.shifting = row.engine_speed = row.turbine_speed = row.engine_torque = 0.0; }

void add_driveline(const vehicle::Vehicle& car, VehicleRow& row) {
  const vehicle::System& system = car.system();
  const vehicle::DriveTrain& drive = car.drive();
  const auto& driveline = car.spec().driveline;
  if (drive.engine()) {
    row.engine_speed += system.shaft(drive.shaft(driveline.engine->shaft)).state.speed;
    row.engine_torque += drive.engine()->torque(system);
  }
  if (const auto& converter = driveline.converter)
    row.turbine_speed += system.shaft(drive.shaft(converter->out)).state.speed;
  if (drive.gearbox() && drive.gearbox()->shifting()) row.shifting += 1.0;
}

void finish_driveline(const vehicle::Vehicle& car, const MotionBefore& before, double duration, int substeps,
                      VehicleRow& row) {
  FURROW_ASSERT(duration > 0.0 && substeps > 0, duration, substeps);
  row.shifting /= substeps;
  for (double* speed : {&row.engine_speed, &row.turbine_speed}) *speed *= 30.0 / std::numbers::pi / substeps;  // 1/min
  row.engine_torque /= substeps;
  row.engine_power = (car.drive().work(car.system()) - before.drive_work) / duration;
}

void measure_motion(const vehicle::Vehicle& car, const MotionBefore& before, double duration, VehicleRow& row) {
  FURROW_ASSERT(duration > 0.0, duration);
  const double psi = yaw_of(car);
  const Vec3 forward(std::cos(psi), std::sin(psi), 0.0), left(-forward.y(), forward.x(), 0.0);
  const Vec3 way = car.origin() - before.origin, gain = car.system().momentum() - before.momentum;
  row.distance += std::hypot(way.x(), way.y());
  row.speed = forward.dot(way) / duration;
  row.lateral_speed = left.dot(way) / duration;
  row.acceleration = forward.dot(gain) / (car.mass() * duration);
  row.lateral_acceleration = left.dot(gain) / (car.mass() * duration);
  row.yaw_rate = std::remainder(psi - row.yaw, 2.0 * std::numbers::pi) / duration;
}

void measure_driver(const vehicle::DriverInputs& inputs, const vehicle::Driver* driver, VehicleRow& row) {
  row.throttle = inputs.throttle;
  row.brake = inputs.brake;
  row.steering = inputs.steering;
  row.lock = inputs.lock ? 1.0 : 0.0;
  if (!driver) return;
  const vehicle::DriverRecord& record = driver->record();
  row.target_speed = record.target_speed;
  row.path_distance = record.path_distance;
  row.cross_track = record.cross_track;
  row.heading_error = record.heading_error;
}

void measure_now(const vehicle::Vehicle& car, const vehicle::DriverInputs& inputs, VehicleRow& row) {
  const Mat3& R = car.system().body(car.chassis()).R;
  const Vec3 origin = car.origin();
  row.x = origin.x();
  row.y = origin.y();
  row.z = origin.z();
  row.roll = std::atan2(R(2, 1), R(2, 2));
  row.pitch = -std::asin(std::clamp(R(2, 0), -1.0, 1.0));
  row.yaw = yaw_of(car);
  row.gear = gear_of(car, inputs);
  const vehicle::VehicleEnergy energy = vehicle::vehicle_energy(car);
  row.drive_work = energy.drive_work;
  row.converter_heat = energy.converter_heat;
  row.clutch_heat = energy.clutch_heat;
  row.shift_heat = energy.shift_heat;
  row.brake_heat = energy.brake_heat;
  row.shock_heat = energy.shock_heat;
  row.spring_energy = energy.springs;
}

}  // namespace furrow::rigs
