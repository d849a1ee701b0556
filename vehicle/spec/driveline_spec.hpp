// What a vehicle file says of its driveline: shafts by name, and what joins them. Tables of speeds are in rpm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vehicle/spec/suspension_spec.hpp"

namespace furrow::vehicle {

struct ShaftSpec {
  static constexpr SchemaName kSchema{"shaft", "A rotor about an axis."};
  std::string name;
  double inertia = 0.0;             // kg m²
  Vec3 axis = Vec3::UnitX();        // a direction in the vehicle's frame
  std::string carrier = "chassis";  // or the name of an axle with a housing
};
void visit_fields(auto&& visit, FieldsOf<ShaftSpec> auto& s) {
  using namespace allowed;
  visit(needed("name", "", not_empty(), "Name of the shaft, by which other parts refer to it."), s.name);
  visit(needed("inertia", "kg m²", above(0).to(1e6), "Moment of inertia."), s.inertia);
  visit(needed("axis", "-", keys::kPoint, "Direction in the vehicle's frame."), s.axis);
  visit(key("carrier", "", "Body in whose bearings the shaft turns: chassis, or the name of a rigid axle."), s.carrier);
}

struct EngineSpec {
  static constexpr SchemaName kSchema{"engine", "An engine from its torque map."};
  std::string shaft;
  Points torque;                 // at full throttle, N m against rpm
  Points losses;                 // N m against rpm
  double idle_rpm = 0.0;         // below which the governor opens the throttle
  double idle_band_rpm = 100.0;  // over which it opens fully
};
void visit_fields(auto&& visit, FieldsOf<EngineSpec> auto& s) {
  using namespace allowed;
  visit(needed("shaft", "", not_empty(), "Shaft that is the engine's crankshaft."), s.shaft);
  visit(needed("torque", "N m", keys::kTable, "Torque at full throttle: pairs of rpm and N m."), s.torque);
  visit(needed("losses", "N m", keys::kTable, "Pairs of rpm and N m, against the speed."), s.losses);
  visit(needed("idle_rpm", "rpm", from(0, 1e6),
               "Speed below which the governor opens the throttle; at most the last speed of torque."),
        s.idle_rpm);
  visit(key("idle_band_rpm", "rpm", above(0).to(1e6),
            "Drop of the speed below idle_rpm over which the governor opens the throttle fully."),
        s.idle_band_rpm);
}

struct ConverterSpec {
  static constexpr SchemaName kSchema{"converter", "A hydrodynamic torque converter."};
  std::string in, out;  // shafts
  Points capacity;      // (rad/s)/√(N m) against the speed ratio, 0 to 1
  Points torque_ratio;  // against the speed ratio
};
void visit_fields(auto&& visit, FieldsOf<ConverterSpec> auto& s) {
  using namespace allowed;
  visit(needed("in", "", not_empty(), "Shaft of the impeller."), s.in);
  visit(needed("out", "", not_empty(), "Shaft of the turbine."), s.out);
  visit(needed("capacity", "", keys::kTable, "Pairs of speed ratio, 0 to 1, and capacity, (rad/s)/√(N m)."),
        s.capacity);
  visit(needed("torque_ratio", "-", keys::kTable, "Pairs of speed ratio, 0 to 1, and torque ratio."), s.torque_ratio);
}

/// A friction clutch that closes with the speed of its input, as a centrifugal one does.
struct ClutchSpec {
  static constexpr SchemaName kSchema{"clutch", "A friction clutch that closes with the speed of its input."};
  std::string in, out;                      // shafts
  double torque = 0.0;                      // closed, N m
  double open_rpm = 0.0, closed_rpm = 0.0;  // of the input
};
void visit_fields(auto&& visit, FieldsOf<ClutchSpec> auto& s) {
  using namespace allowed;
  visit(keys::kIn, s.in);
  visit(keys::kOut, s.out);
  visit(needed("torque", "N m", above(0).to(1e8), "Torque that the closed clutch can carry."), s.torque);
  visit(needed("open_rpm", "rpm", "Speed at which the clutch begins to close."), s.open_rpm);
  visit(needed("closed_rpm", "rpm", "Speed at which the clutch is closed."), s.closed_rpm);
}

struct GearboxSpec {
  static constexpr SchemaName kSchema{"gearbox", "An automatic gearbox."};
  std::string in, out;                  // shafts
  std::vector<double> ratios;           // output over input, forward gears from the lowest
  std::optional<double> reverse;        // output over input, negative
  double shift_time = 0.0;              // s
  double up_rpm = 0.0, down_rpm = 0.0;  // of the input
  double latency = 1.0;                 // between the starts of two shifts, s
};
void visit_fields(auto&& visit, FieldsOf<GearboxSpec> auto& s) {
  using namespace allowed;
  visit(keys::kIn, s.in);
  visit(keys::kOut, s.out);
  visit(needed("ratios", "-",
               shaped(R"({"type": "array", "minItems": 1, "items": {"type": "number", "exclusiveMinimum": 0}})"),
               "Ratio of each gear from the lowest, output over input."),
        s.ratios);
  visit(key("reverse", "-", below(0), "Ratio of the reverse gear, output over input; negative."), s.reverse);
  visit(needed("shift_time", "s", from(0), "Time of a change of gear; 0: the speeds meet in an impact."), s.shift_time);
  visit(needed("up_rpm", "rpm", above(0), "Speed of the input above which the gearbox shifts up."), s.up_rpm);
  visit(needed("down_rpm", "rpm", above(0).to(1e6), "Speed of the input below which the gearbox shifts down."),
        s.down_rpm);
  visit(key("latency", "s", above(0), "Least time between the starts of two shifts."), s.latency);
}

/// Between two shafts of one carrier: a gear. Between two carriers: a shaft with joints, whose ratio is 1.
struct GearSpec {
  static constexpr SchemaName kSchema{
      "gear", "A gear between two shafts of one carrier, or a shaft with joints between shafts of two carriers."};
  std::string name;
  std::string in, out;  // shafts
  double ratio = 1.0;   // output over input
};
void visit_fields(auto&& visit, FieldsOf<GearSpec> auto& s) {
  using namespace allowed;
  visit(needed("name", "", not_empty(), "Name of the joint in messages."), s.name);
  visit(keys::kIn, s.in);
  visit(keys::kOut, s.out);
  visit(needed("ratio", "-", "Ratio, output over input, not 0; 1 between two carriers."), s.ratio);
}

struct DifferentialSpec {
  static constexpr SchemaName kSchema{"differential", "An open differential, perhaps with a lock."};
  std::string name;
  std::string box;                    // shaft
  std::vector<std::string> outputs;   // two shafts
  double share = 0.5;                 // of the torque that goes to the first output
  std::optional<double> lock_torque;  // of the clutch between the outputs, when locked, N m
};
void visit_fields(auto&& visit, FieldsOf<DifferentialSpec> auto& s) {
  using namespace allowed;
  visit(needed("name", "", not_empty(), "Name of the differential in messages."), s.name);
  visit(needed("box", "", not_empty(), "Shaft that drives the differential's housing."), s.box);
  visit(needed("outputs", "", shaped(R"({"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "string"}})"),
               "The two output shafts."),
        s.outputs);
  visit(key("share", "-", above(0).below(1), "Share of the torque that goes to the first output."), s.share);
  visit(key("lock_torque", "N m", above(0).to(1e8),
            "Torque of the clutch between the outputs when the driver locks it. Without this key there is no lock."),
        s.lock_torque);
}

/// A shaft that turns with a wheel.
struct WheelShaftSpec {
  static constexpr SchemaName kSchema{"wheel_shaft", "A shaft that turns with a wheel."};
  std::string shaft;
  std::string axle, side;  // side: left or right
};
void visit_fields(auto&& visit, FieldsOf<WheelShaftSpec> auto& s) {
  using namespace allowed;
  visit(needed("shaft", "", not_empty(), "Shaft that turns with the wheel."), s.shaft);
  visit(needed("axle", "", not_empty(), "Name of the wheel's axle."), s.axle);
  visit(needed("side", "", words("left right"), "Side of the axle."), s.side);
}

/// An electric motor at each wheel of an axle: torque = stall_torque (command − speed/no_load_speed).
struct MotorSpec {
  static constexpr SchemaName kSchema{
      "motor",
      "An electric motor at each wheel of an axle: torque = stall torque × (command − speed / speed without load)."};
  std::string axle;
  double inertia = 0.0;       // of the rotor, kg m²
  double gear_ratio = 1.0;    // motor over wheel
  double stall_torque = 0.0;  // of the motor, N m
  double no_load_rpm = 0.0;   // of the motor
};
void visit_fields(auto&& visit, FieldsOf<MotorSpec> auto& s) {
  using namespace allowed;
  visit(needed("axle", "", not_empty(), "Name of the axle."), s.axle);
  visit(needed("inertia", "kg m²", above(0).to(1e6), "Moment of inertia of the rotor."), s.inertia);
  visit(needed("gear_ratio", "-", "Speed of the motor over that of the wheel, not 0."), s.gear_ratio);
  visit(needed("stall_torque", "N m", above(0).to(1e8), "Torque of the motor at rest."), s.stall_torque);
  visit(needed("no_load_rpm", "rpm", above(0).to(1e6), "Speed of the motor without load."), s.no_load_rpm);
}

struct DrivelineSpec {
  static constexpr SchemaName kSchema{"driveline", "Shafts by name, and what joins and drives them."};
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
void visit_fields(auto&& visit, FieldsOf<DrivelineSpec> auto& s) {
  using namespace allowed;
  visit(key("shafts", "", "All shafts, but the rotors of motors."), s.shafts);
  visit(key("engine"), s.engine);
  visit(key("converter"), s.converter);
  visit(key("clutch"), s.clutch);
  visit(key("gearbox"), s.gearbox);
  visit(key("gears", "", "Gears, and shafts with joints."), s.gears);
  visit(key("differentials", "", "Open differentials."), s.differentials);
  visit(key("wheels", "", "Shafts that turn with wheels."), s.wheels);
  visit(key("motors", "", "Motors at wheels."), s.motors);
  visit(key("skid_steer", "-", from(0, 1),
            "Share of the motors' command that full steering takes from the inner side and gives to the outer one."),
        s.skid_steer);
}

}  // namespace furrow::vehicle
