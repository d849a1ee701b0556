// A driver computes throttle, brake, steering, gear and differential locks from a vehicle's present motion.
#pragma once

#include <cmath>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::vehicle {

/// A driver's observation of its vehicle.
struct DriverView {
  double time = 0.0;             // s
  Vec3 position = Vec3::Zero();  // middle of the rear axle, W, m
  Vec3 velocity = Vec3::Zero();  // of this point, W, m/s
  double yaw = 0.0;              // of the vehicle's x axis about z, from the x axis of W, rad
  double yaw_rate = 0.0;         // rad/s
  /// Along the vehicle's x axis in the horizontal plane, m/s; negative backwards.
  double speed() const { return velocity.x() * std::cos(yaw) + velocity.y() * std::sin(yaw); }
};

/// Gears in a driver's numbering: 1 is the lowest forward gear.
namespace gear_request {
inline constexpr int automatic = -2;  // the gearbox decides
inline constexpr int reverse = -1;
inline constexpr int neutral = 0;
}  // namespace gear_request

/// A driver's commands.
struct DriverInputs {
  double throttle = 0.0;               // 0 to 1
  double brake = 0.0;                  // 0 to 1
  double steering = 0.0;               // −1 to 1, positive to the left
  int gear = gear_request::automatic;  // or reverse, neutral, 1, 2, …
  bool lock = false;                   // of all differentials that have one
};
void visit_fields(FieldsOf<DriverInputs> auto& s, auto&& visit) {
  visit(s.throttle, Field{"throttle", "-", role::column});
  visit(s.brake, Field{"brake", "-", role::column});
  visit(s.steering, Field{"steering", "-", role::column});
  visit(s.gear, Field{"gear_request", "-", role::column});
  visit(s.lock, Field{"lock", "-", role::column});
}

/// Properties of its vehicle that a driver is given.
struct DriverCar {
  double wheelbase = 0.0;      // from the rear axle to the one that steers, m
  double steering_lock = 0.0;  // mean angle of the road wheels at steering 1, rad: the angle of the steering wheel
                               // divided by the steering ratio
  double width = 0.0;          // m
  double mass = 0.0;           // of everything that moves with it, kg
  double drive_force = 0.0;    // largest at the wheels, limited by engine or grip, N
  double brake_force = 0.0;    // largest at the wheels, N
};
void visit_fields(FieldsOf<DriverCar> auto& s, auto&& visit) {
  visit(s.wheelbase, Field{"wheelbase", "m"});
  visit(s.steering_lock, Field{"steering_lock", "rad"});
  visit(s.width, Field{"width", "m"});
  visit(s.mass, Field{"mass", "kg"});
  visit(s.drive_force, Field{"drive_force", "N"});
  visit(s.brake_force, Field{"brake_force", "N"});
}

/// Values for the table of results. Values without a control loop are zero.
struct DriverRecord {
  DriverInputs inputs;
  double target_speed = 0.0;   // m/s
  double path_distance = 0.0;  // travelled along the path, m
  double cross_track = 0.0;    // from the path, positive left of it, m
  double heading_error = 0.0;  // the vehicle's yaw minus the path's, −π to π, rad
  bool path_ended = false;     // whether its last point was passed
  double path_end_time = 0.0;  // time at which this was first noticed, s
};
void visit_fields(FieldsOf<DriverRecord> auto& s, auto&& visit) {
  visit(s.inputs, Field{"inputs", ""});
  visit(s.target_speed, Field{"target_speed", "m/s", role::column});
  visit(s.path_distance, Field{"path_distance", "m", role::column});
  visit(s.cross_track, Field{"cross_track", "m", role::column});
  visit(s.heading_error, Field{"heading_error", "rad", role::column});
  visit(s.path_ended, Field{"path_ended", ""});
  visit(s.path_end_time, Field{"path_end_time", "s"});
}

class Driver {
 public:
  virtual ~Driver() = default;
  /// Called once per exchange, for the interval that begins now. A second call at the same time returns the same
  /// inputs.
  /// @pre time does not go back
  virtual DriverInputs drive(const DriverView& view) = 0;
  /// Record of the last call.
  virtual const DriverRecord& record() const = 0;
  /// Saves everything that the next call depends on: a restored driver continues bit for bit.
  virtual void save(Archive& archive) const = 0;
  virtual void restore(const Archive& archive) = 0;
};

}  // namespace furrow::vehicle
