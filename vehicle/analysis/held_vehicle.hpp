// Rows that trim and kinematics hold in addition to the vehicle's own.
#pragma once

#include "vehicle/multibody/statics.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

/// Holds the wheels at their present angles in their bearings.
inline void hold_spins(const Vehicle& vehicle, Statics& statics) {
  const System& system = vehicle.system();
  for (int k = 0; k < vehicle.wheel_count(); ++k) {
    const Row row = free_coordinate(system.joint(vehicle.wheel(k).bearing));
    statics.hold({vehicle.wheel(k).name + " spin", row, row_value(system, row)});
  }
}

/// Direction of a wheel's axle, W.
inline Vec3 spin_axis(const Vehicle& vehicle, int wheel) {
  return vehicle.system().body(vehicle.wheel(wheel).spindle).R * Vec3::UnitY();
}

}  // namespace furrow::vehicle
