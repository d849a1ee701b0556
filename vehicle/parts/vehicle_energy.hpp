// Where the energy of a vehicle is and went, each entry from its own account: bodies and springs from their state,
// drives, clutches, brakes and shock absorbers from impulse times the mean of the speeds
// before and after it (system.hpp).
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
  double shift_heat = 0.0;      // what changes of gear took
  double brake_heat = 0.0;
  double shock_heat = 0.0;

  double stored() const { return kinetic + gravity + springs; }
  double lost() const { return converter_heat + clutch_heat + shift_heat + brake_heat + shock_heat; }
};
void visit_fields(auto&& visit, FieldsOf<VehicleEnergy> auto& s) {
  visit(Field{"kinetic", "J"}, s.kinetic);
  visit(Field{"gravity", "J"}, s.gravity);
  visit(Field{"springs", "J"}, s.springs);
  visit(Field{"drive_work", "J"}, s.drive_work);
  visit(Field{"converter_heat", "J"}, s.converter_heat);
  visit(Field{"clutch_heat", "J"}, s.clutch_heat);
  visit(Field{"shift_heat", "J"}, s.shift_heat);
  visit(Field{"brake_heat", "J"}, s.brake_heat);
  visit(Field{"shock_heat", "J"}, s.shock_heat);
}

VehicleEnergy vehicle_energy(const Vehicle& vehicle);

}  // namespace furrow::vehicle
