// The driveline of a vehicle file: named shafts, and the parts that join them. Tables of speeds are in rpm.
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
void visit_fields(FieldsOf<ShaftSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.name, needed("name", "", not_empty(), "Name of the shaft, by which other parts refer to it."));
  visit(s.inertia, needed("inertia", "kg m²", above(0).to(1e6), "Moment of inertia."));
  visit(s.axis, needed("axis", "-", keys::kPoint, "Direction in the vehicle's frame."));
  visit(s.carrier, key("carrier", "", "Body in whose bearings the shaft turns: chassis, or the name of a rigid axle."));
}

struct EngineSpec {
  static constexpr SchemaName kSchema{"engine", "An engine from its torque map."};
  std::string shaft;
  Points torque;                 // that full throttle adds, N m against rpm
  Points losses;                 // with the throttle closed, N m against rpm
  double idle_rpm = 0.0;         // below which the governor opens the throttle
  double idle_band_rpm = 100.0;  // over which it opens fully
};
void visit_fields(FieldsOf<EngineSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.shaft, needed("shaft", "", not_empty(), "Shaft that is the engine's crankshaft."));
  visit(s.torque,
        needed("torque", "N m", keys::kTable, "Torque that full throttle adds to the losses: pairs of rpm and N m."));
  visit(s.losses, needed("losses", "N m", keys::kTable,
                         "Torque with the throttle closed, against the speed: pairs of rpm and N m."));
  visit(s.idle_rpm, needed("idle_rpm", "rpm", from(0, 1e6),
                           "Speed below which the governor opens the throttle; at most the last speed of torque."));
  visit(s.idle_band_rpm, key("idle_band_rpm", "rpm", above(0).to(1e6),
                             "Drop of the speed below idle_rpm over which the governor opens the throttle fully."));
}

struct ConverterSpec {
  static constexpr SchemaName kSchema{"converter", "A hydrodynamic torque converter."};
  std::string in, out;  // shafts
  Points capacity;      // (rad/s)/√(N m) against the speed ratio, 0 to 1
  Points torque_ratio;  // against the speed ratio
};
void visit_fields(FieldsOf<ConverterSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.in, needed("in", "", not_empty(), "Shaft of the impeller."));
  visit(s.out, needed("out", "", not_empty(), "Shaft of the turbine."));
  visit(s.capacity,
        needed("capacity", "", keys::kTable, "Pairs of speed ratio, 0 to 1, and capacity, (rad/s)/√(N m)."));
  visit(s.torque_ratio, needed("torque_ratio", "-", keys::kTable, "Pairs of speed ratio, 0 to 1, and torque ratio."));
}

/// A friction clutch that closes with the speed of its input, like a centrifugal clutch.
struct ClutchSpec {
  static constexpr SchemaName kSchema{"clutch", "A friction clutch that closes with the speed of its input."};
  std::string in, out;                      // shafts
  double torque = 0.0;                      // closed, N m
  double open_rpm = 0.0, closed_rpm = 0.0;  // of the input
};
void visit_fields(FieldsOf<ClutchSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.in, keys::kIn);
  visit(s.out, keys::kOut);
  visit(s.torque, needed("torque", "N m", above(0).to(1e8), "Torque that the closed clutch can carry."));
  visit(s.open_rpm, needed("open_rpm", "rpm", "Speed at which the clutch begins to close."));
  visit(s.closed_rpm, needed("closed_rpm", "rpm", "Speed at which the clutch is closed."));
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
void visit_fields(FieldsOf<GearboxSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.in, keys::kIn);
  visit(s.out, keys::kOut);
  visit(s.ratios,
        needed("ratios", "-",
               shaped(R"({"type": "array", "minItems": 1, "items": {"type": "number", "exclusiveMinimum": 0}})"),
               "Ratio of each gear from the lowest, output over input."));
  visit(s.reverse, key("reverse", "-", below(0), "Ratio of the reverse gear, output over input; negative."));
  visit(s.shift_time, needed("shift_time", "s", from(0), "Time of a change of gear; 0: the speeds meet in an impact."));
  visit(s.up_rpm, needed("up_rpm", "rpm", above(0), "Speed of the input above which the gearbox shifts up."));
  visit(s.down_rpm,
        needed("down_rpm", "rpm", above(0).to(1e6), "Speed of the input below which the gearbox shifts down."));
  visit(s.latency, key("latency", "s", above(0), "Least time between the starts of two shifts."));
}

/// Between two shafts of one carrier: a gear. Between two carriers: a shaft with joints, whose ratio is 1.
struct GearSpec {
  static constexpr SchemaName kSchema{
      "gear", "A gear between two shafts of one carrier, or a shaft with joints between shafts of two carriers."};
  std::string name;
  std::string in, out;  // shafts
  double ratio = 1.0;   // output over input
};
void visit_fields(FieldsOf<GearSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.name, needed("name", "", not_empty(), "Name of the joint in messages."));
  visit(s.in, keys::kIn);
  visit(s.out, keys::kOut);
  visit(s.ratio, needed("ratio", "-", "Ratio, output over input, not 0; 1 between two carriers."));
}

struct DifferentialSpec {
  static constexpr SchemaName kSchema{"differential", "An open differential, perhaps with a lock."};
  std::string name;
  std::string box;                    // shaft
  std::vector<std::string> outputs;   // two shafts
  double share = 0.5;                 // of the torque that goes to the first output
  std::optional<double> lock_torque;  // of the clutch between the outputs, when locked, N m
};
void visit_fields(FieldsOf<DifferentialSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.name, needed("name", "", not_empty(), "Name of the differential in messages."));
  visit(s.box, needed("box", "", not_empty(), "Shaft that drives the differential's housing."));
  visit(s.outputs,
        needed("outputs", "", shaped(R"({"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "string"}})"),
               "The two output shafts."));
  visit(s.share, key("share", "-", above(0).below(1), "Share of the torque that goes to the first output."));
  visit(s.lock_torque,
        key("lock_torque", "N m", above(0).to(1e8),
            "Torque of the clutch between the outputs when the driver locks it. Without this key there is no lock."));
}

/// A shaft that turns with a wheel.
struct WheelShaftSpec {
  static constexpr SchemaName kSchema{"wheel_shaft", "A shaft that turns with a wheel."};
  std::string shaft;
  std::string axle, side;  // side: left or right
};
void visit_fields(FieldsOf<WheelShaftSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.shaft, needed("shaft", "", not_empty(), "Shaft that turns with the wheel."));
  visit(s.axle, needed("axle", "", not_empty(), "Name of the wheel's axle."));
  visit(s.side, needed("side", "", words("left right"), "Side of the axle."));
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
void visit_fields(FieldsOf<MotorSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.axle, needed("axle", "", not_empty(), "Name of the axle."));
  visit(s.inertia, needed("inertia", "kg m²", above(0).to(1e6), "Moment of inertia of the rotor."));
  visit(s.gear_ratio, needed("gear_ratio", "-", "Speed of the motor over that of the wheel, not 0."));
  visit(s.stall_torque, needed("stall_torque", "N m", above(0).to(1e8), "Torque of the motor at rest."));
  visit(s.no_load_rpm, needed("no_load_rpm", "rpm", above(0).to(1e6), "Speed of the motor without load."));
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
void visit_fields(FieldsOf<DrivelineSpec> auto& s, auto&& visit) {
  using namespace allowed;
  visit(s.shafts, key("shafts", "", "All shafts, but the rotors of motors."));
  visit(s.engine, key("engine"));
  visit(s.converter, key("converter"));
  visit(s.clutch, key("clutch"));
  visit(s.gearbox, key("gearbox"));
  visit(s.gears, key("gears", "", "Gears, and shafts with joints."));
  visit(s.differentials, key("differentials", "", "Open differentials."));
  visit(s.wheels, key("wheels", "", "Shafts that turn with wheels."));
  visit(s.motors, key("motors", "", "Motors at wheels."));
  visit(s.skid_steer,
        key("skid_steer", "-", from(0, 1),
            "Share of the motors' command that full steering takes from the inner side and gives to the outer one."));
}

}  // namespace furrow::vehicle
