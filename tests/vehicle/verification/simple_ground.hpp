// Simple laws of contact for whole vehicles on hard, even ground. On a slope, gravity is tilted and the ground stays at
// z = 0. Tires push with a stiffness and a damper.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "protocol/core/constants.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::testing {

/// Gravity of a slope that rises by `grade` along x, m/s².
inline Vec3 gravity_on_slope(double grade) {
  return kStandardGravity / std::sqrt(1.0 + grade * grade) * Vec3(-grade, 0.0, -1.0);
}

/// Contact of one wheel: a spring that sticks until the limit of friction, or a force that follows the slip speed.
struct GroundContact {
  double radius = 0.4673, stiffness = 3.3e5, damping = 3e3;  // m, N/m, N s/m
  double friction = 0.9;
  double shear_stiffness = 3e5, shear_damping = 3e3;  // N/m, N s/m
  Vec3 stretch = Vec3::Zero();                        // of the spring along the ground, m

  double load(const RimState& rim) const {
    return std::max(0.0, stiffness * (radius - rim.position.z()) - damping * rim.velocity.z());
  }
  static Vec3 sliding(const RimState& rim) {
    Vec3 v = rim.velocity + rim.angular_velocity.cross(Vec3(0, 0, -rim.position.z()));
    v.z() = 0.0;
    return v;
  }
  static Wrench at_ground(const RimState& rim, const Vec3& force) {
    return {force, Vec3(0, 0, -rim.position.z()).cross(force)};
  }

  /// The tire sticks; the spring's anchor slides if the force would exceed friction.
  Wrench stick(const RimState& rim, double h) {
    const double normal = load(rim), most = friction * normal;
    const Vec3 v = sliding(rim);
    stretch += h * v;
    if (shear_stiffness * stretch.norm() > most) stretch *= most / (shear_stiffness * stretch.norm());
    Vec3 force = -shear_stiffness * stretch - shear_damping * v;
    if (force.norm() > most) force *= most / force.norm();
    return at_ground(rim, force + normal * Vec3::UnitZ());
  }
  /// The force follows the slip speed over a width of about `width`, m/s.
  Wrench roll(const RimState& rim, double width) const {
    const double normal = load(rim);
    const Vec3 v = sliding(rim);
    const Vec3 force(-friction * normal * std::tanh(v.x() / width), -friction * normal * std::tanh(v.y() / width),
                     normal);
    return at_ground(rim, force);
  }
};

/// Lowers a vehicle until its wheels' springs carry about its weight.
inline void put_on_ground(vehicle::Vehicle& car, const GroundContact& contact) {
  double lowest = 1e300;
  for (int k = 0; k < car.wheel_count(); ++k) lowest = std::min(lowest, car.rim(k).position.z());
  const double deflection = car.mass() * kStandardGravity / car.wheel_count() / contact.stiffness;
  car.move(Vec3(0, 0, contact.radius - deflection - lowest));
}

/// Adds the mass of the tires, which the vehicle's file does not contain.
inline void add_tires(vehicle::Vehicle& car) {
  MassProperties tire;
  tire.mass = 25.0;
  tire.inertia = Vec3(2.0, 3.6, 2.0).asDiagonal();
  for (int k = 0; k < car.wheel_count(); ++k) car.add_tire_mass(k, tire);
}

}  // namespace furrow::testing
