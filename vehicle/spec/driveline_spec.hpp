// What a vehicle file says of its driveline: shafts by name, and what joins them. Tables of speeds are in rpm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

struct ShaftSpec {
  std::string name;
  double inertia = 0.0;             // kg m²
  Vec3 axis = Vec3::UnitX();        // a direction in the vehicle's frame
  std::string carrier = "chassis";  // or the name of an axle with a housing
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ShaftSpec> auto& s) {
  visit(Field{"name", "", role::key}, s.name);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
  visit(Field{"axis", "-", role::key}, s.axis);
  visit(Field{"carrier", "", role::key | kMayMiss}, s.carrier);
}

struct EngineSpec {
  std::string shaft;
  Points torque;                 // at full throttle, N m against rpm
  Points losses;                 // N m against rpm
  double idle_rpm = 0.0;         // below which the governor opens the throttle
  double idle_band_rpm = 100.0;  // over which it opens fully
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<EngineSpec> auto& s) {
  visit(Field{"shaft", "", role::key}, s.shaft);
  visit(Field{"torque", "N m", role::key}, s.torque);
  visit(Field{"losses", "N m", role::key}, s.losses);
  visit(Field{"idle_rpm", "rpm", role::key}, s.idle_rpm);
  visit(Field{"idle_band_rpm", "rpm", role::key | kMayMiss}, s.idle_band_rpm);
}

struct ConverterSpec {
  std::string in, out;  // shafts
  Points capacity;      // (rad/s)/√(N m) against the speed ratio, 0 to 1
  Points torque_ratio;  // against the speed ratio
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ConverterSpec> auto& s) {
  visit(Field{"in", "", role::key}, s.in);
  visit(Field{"out", "", role::key}, s.out);
  visit(Field{"capacity", "", role::key}, s.capacity);
  visit(Field{"torque_ratio", "-", role::key}, s.torque_ratio);
}

/// A friction clutch that closes with the speed of its input, as a centrifugal one does.
struct ClutchSpec {
  std::string in, out;                      // shafts
  double torque = 0.0;                      // closed, N m
  double open_rpm = 0.0, closed_rpm = 0.0;  // of the input
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<ClutchSpec> auto& s) {
  visit(Field{"in", "", role::key}, s.in);
  visit(Field{"out", "", role::key}, s.out);
  visit(Field{"torque", "N m", role::key}, s.torque);
  visit(Field{"open_rpm", "rpm", role::key}, s.open_rpm);
  visit(Field{"closed_rpm", "rpm", role::key}, s.closed_rpm);
}

struct GearboxSpec {
  std::string in, out;                  // shafts
  std::vector<double> ratios;           // output over input, forward gears from the lowest
  std::optional<double> reverse;        // output over input, negative
  double shift_time = 0.0;              // s
  double up_rpm = 0.0, down_rpm = 0.0;  // of the input
  double latency = 1.0;                 // between the starts of two shifts, s
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<GearboxSpec> auto& s) {
  visit(Field{"in", "", role::key}, s.in);
  visit(Field{"out", "", role::key}, s.out);
  visit(Field{"ratios", "-", role::key}, s.ratios);
  visit(Field{"reverse", "-", role::key}, s.reverse);
  visit(Field{"shift_time", "s", role::key}, s.shift_time);
  visit(Field{"up_rpm", "rpm", role::key}, s.up_rpm);
  visit(Field{"down_rpm", "rpm", role::key}, s.down_rpm);
  visit(Field{"latency", "s", role::key | kMayMiss}, s.latency);
}

/// Between two shafts of one carrier: a gear. Between two carriers: a shaft with joints, whose ratio is 1.
struct GearSpec {
  std::string name;
  std::string in, out;  // shafts
  double ratio = 1.0;   // output over input
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<GearSpec> auto& s) {
  visit(Field{"name", "", role::key}, s.name);
  visit(Field{"in", "", role::key}, s.in);
  visit(Field{"out", "", role::key}, s.out);
  visit(Field{"ratio", "-", role::key}, s.ratio);
}

struct DifferentialSpec {
  std::string name;
  std::string box;                    // shaft
  std::vector<std::string> outputs;   // two shafts
  double share = 0.5;                 // of the torque that goes to the first output
  std::optional<double> lock_torque;  // of the clutch between the outputs, when locked, N m
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DifferentialSpec> auto& s) {
  visit(Field{"name", "", role::key}, s.name);
  visit(Field{"box", "", role::key}, s.box);
  visit(Field{"outputs", "", role::key}, s.outputs);
  visit(Field{"share", "-", role::key | kMayMiss}, s.share);
  visit(Field{"lock_torque", "N m", role::key}, s.lock_torque);
}

/// A shaft that turns with a wheel.
struct WheelShaftSpec {
  std::string shaft;
  std::string axle, side;  // side: left or right
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<WheelShaftSpec> auto& s) {
  visit(Field{"shaft", "", role::key}, s.shaft);
  visit(Field{"axle", "", role::key}, s.axle);
  visit(Field{"side", "", role::key}, s.side);
}

/// An electric motor at each wheel of an axle: torque = stall_torque (command − speed/no_load_speed).
struct MotorSpec {
  std::string axle;
  double inertia = 0.0;       // of the rotor, kg m²
  double gear_ratio = 1.0;    // motor over wheel
  double stall_torque = 0.0;  // of the motor, N m
  double no_load_rpm = 0.0;   // of the motor
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<MotorSpec> auto& s) {
  visit(Field{"axle", "", role::key}, s.axle);
  visit(Field{"inertia", "kg m²", role::key}, s.inertia);
  visit(Field{"gear_ratio", "-", role::key}, s.gear_ratio);
  visit(Field{"stall_torque", "N m", role::key}, s.stall_torque);
  visit(Field{"no_load_rpm", "rpm", role::key}, s.no_load_rpm);
}

struct DrivelineSpec {
  std::vector<ShaftSpec> shafts;
  std::optional<EngineSpec> engine;
  std::optional<ConverterSpec> converter;
  std::optional<ClutchSpec> clutch;
  std::optional<GearboxSpec> gearbox;
  std::vector<GearSpec> gears;
  std::vector<DifferentialSpec> differentials;
  std::vector<WheelShaftSpec> wheels;
  std::vector<MotorSpec> motors;
  double skid_steer = 0.0;  // share of the motors' command that the steering wheel takes from the inner side

  /// Index of a shaft, or −1.
  int shaft(const std::string& wanted) const {
    for (std::size_t k = 0; k < shafts.size(); ++k)
      if (shafts[k].name == wanted) return static_cast<int>(k);
    return -1;
  }
};
template <class Visit>
void visit_fields(Visit&& visit, FieldsOf<DrivelineSpec> auto& s) {
  visit(Field{"shafts", "", role::key | kMayMiss}, s.shafts);
  visit(Field{"engine", "", role::key}, s.engine);
  visit(Field{"converter", "", role::key}, s.converter);
  visit(Field{"clutch", "", role::key}, s.clutch);
  visit(Field{"gearbox", "", role::key}, s.gearbox);
  visit(Field{"gears", "", role::key | kMayMiss}, s.gears);
  visit(Field{"differentials", "", role::key | kMayMiss}, s.differentials);
  visit(Field{"wheels", "", role::key | kMayMiss}, s.wheels);
  visit(Field{"motors", "", role::key | kMayMiss}, s.motors);
  visit(Field{"skid_steer", "-", role::key | kMayMiss}, s.skid_steer);
}

}  // namespace furrow::vehicle
