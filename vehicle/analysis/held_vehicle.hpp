// Rows that trim and kinematics hold besides the vehicle's own.
#pragma once

#include "vehicle/multibody/statics.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

/// Wheels keep the angle that they have now in their bearings.
inline void hold_spins(const Vehicle& vehicle, Statics& statics) {
  const System& system = vehicle.system();
  for (int k = 0; k < vehicle.wheel_count(); ++k) {
    const Row row = free_coordinate(system.joint(vehicle.wheel(k).bearing));
    statics.hold({vehicle.wheel(k).name + " spin", row, row_value(system, row)});
  }
}

/// The axle's direction of a wheel, W.
inline Vec3 spin_axis(const Vehicle& vehicle, int wheel) {
  return vehicle.system().body(vehicle.wheel(wheel).spindle).R * Vec3::UnitY();
}

}  // namespace furrow::vehicle
