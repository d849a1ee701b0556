// A vehicle: a multibody system built from its spec, with access to its parts. Tires and soil are not part of it; each
// tire exerts a wrench on its rim and receives the rim's motion.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/surface.hpp"
#include "vehicle/parts/drive_train.hpp"
#include "vehicle/parts/steering.hpp"
#include "vehicle/parts/suspension.hpp"

namespace furrow::vehicle {

class Vehicle {
 public:
  /// Builds the vehicle as drawn: in the vehicle's frame, at rest, the engine idling.
  /// @throws Error(physics) naming a joint that cannot be closed or is redundant
  explicit Vehicle(const VehicleSpec& spec, const Vec3& gravity = standard_gravity());
  Vehicle(const Vehicle&) = delete;  // the system's laws refer to its parts
  Vehicle& operator=(const Vehicle&) = delete;

  const VehicleSpec& spec() const { return spec_; }
  System& system() { return system_; }
  const System& system() const { return system_; }
  int chassis() const { return chassis_; }
  /// Two for each axle of the spec, in its order: left, right.
  int wheel_count() const { return static_cast<int>(wheels_.size()); }
  const Wheel& wheel(int k) const {
    FURROW_ASSERT(in_range(k, wheels_.size()), k, wheels_.size());
    return wheels_[k];
  }
  /// Steering of an axle; none if it is not steered.
  std::optional<Steering>& steering(int axle) { return steerings_[axle]; }
  const std::optional<Steering>& steering(int axle) const { return steerings_[axle]; }
  DriveTrain& drive() { return *drive_; }
  const DriveTrain& drive() const { return *drive_; }
  /// Brake of a wheel; none if it has none.
  const std::optional<FrictionCoupling>& brake(int wheel) const { return brakes_[wheel]; }

  double mass() const;  // with the tires added, kg
  /// Origin of the vehicle's frame now, m, W.
  Vec3 origin() const;
  /// Number of freedoms: of bodies and shafts, minus those that joints, motors and gears hold.
  int freedoms() const;

  /// Adds a tire's rigid-body mass properties to the rim of wheel k.
  void add_tire_mass(int wheel, const MassProperties& tire);
  RimState rim(int wheel) const;
  /// Sets the tire's wrench on the rim, about the rim's centre, W, until changed.
  void set_wrench(int wheel, const Wrench& wrench);
  /// Sets the inputs until changed. @pre they are within their ranges
  void set_inputs(const VehicleInputs& inputs);
  /// Moves everything by a displacement, m.
  void move(const Vec3& by);
  /// Turns everything about a point.
  void turn(const Quat& turn, const Vec3& about);
  /// Moves everything along the vehicle's heading, m/s, on wheels of these radii, m, that roll; in a forward gear from
  /// 1, or with 0 as the gearbox decides. @pre before the first step
  void begin_rolling(double speed, std::span<const double> radii, int gear);
  Outcome step(double h);

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  void add_axles();

  VehicleSpec spec_;
  System system_;
  int chassis_ = 0;
  std::vector<Wheel> wheels_;
  std::vector<std::optional<Steering>> steerings_;
  std::vector<std::optional<FrictionCoupling>> brakes_;
  std::unique_ptr<DriveTrain> drive_;
};

}  // namespace furrow::vehicle
