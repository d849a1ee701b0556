// The energies of a vehicle and the works on it, each computed on its own. Energies of bodies and springs follow from
// their state. Works of drives, clutches, brakes and shock absorbers are impulse times the mean of the speeds before
// and after it (system.hpp).
#pragma once

#include "protocol/core/fields.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

/// J; works and heats since the vehicle was built.
struct VehicleEnergy {
  double kinetic = 0.0;         // of bodies and shafts, now
  double gravity = 0.0;         // now
  double springs = 0.0;         // now
  double drive_work = 0.0;      // of engine, with its drag, and motors
  double converter_heat = 0.0;  // of the fluid
  double clutch_heat = 0.0;     // of clutch and locks
  double shift_heat = 0.0;      // dissipated by changes of gear
  double brake_heat = 0.0;
  double shock_heat = 0.0;

  double lost() const { return converter_heat + clutch_heat + shift_heat + brake_heat + shock_heat; }
};
void visit_fields(FieldsOf<VehicleEnergy> auto& s, auto&& visit) {
  visit(s.kinetic, Field{"kinetic", "J"});
  visit(s.gravity, Field{"gravity", "J"});
  visit(s.springs, Field{"springs", "J"});
  visit(s.drive_work, Field{"drive_work", "J"});
  visit(s.converter_heat, Field{"converter_heat", "J"});
  visit(s.clutch_heat, Field{"clutch_heat", "J"});
  visit(s.shift_heat, Field{"shift_heat", "J"});
  visit(s.brake_heat, Field{"brake_heat", "J"});
  visit(s.shock_heat, Field{"shock_heat", "J"});
}

VehicleEnergy vehicle_energy(const Vehicle& vehicle);

}  // namespace furrow::vehicle
