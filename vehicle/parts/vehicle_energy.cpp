#include "vehicle/parts/vehicle_energy.hpp"

namespace furrow::vehicle {

VehicleEnergy vehicle_energy(const Vehicle& vehicle) {
  const System& system = vehicle.system();
  const DriveTrain& drive = vehicle.drive();
  VehicleEnergy e;
  e.kinetic = system.kinetic_energy();
  e.gravity = system.gravity_energy();
  for (int k = 0; k < vehicle.wheel_count(); ++k) {
    const Wheel& wheel = vehicle.wheel(k);
    for (const std::optional<int>& element : {wheel.spring, wheel.shock}) {
      if (!element) continue;
      const ElementEnergy energy = system.element_energy(*element);
      e.springs += energy.stored;
      e.shock_heat += energy.dissipated;
    }
    if (const std::optional<FrictionCoupling>& brake = vehicle.brake(k)) e.brake_heat += brake->heat(system);
  }
  e.drive_work = drive.work(system);
  if (drive.converter()) e.converter_heat = drive.converter()->heat(system);
  if (drive.clutch()) e.clutch_heat = drive.clutch()->heat(system);
  for (const FrictionCoupling& lock : drive.locks()) e.clutch_heat += lock.heat(system);
  if (drive.gearbox()) e.shift_heat = drive.gearbox()->loss(system);
  return e;
}

}  // namespace furrow::vehicle
