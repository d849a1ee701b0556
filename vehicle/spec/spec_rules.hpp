// Rules for the values within each struct of a vehicle file. Rules across structs are in read_vehicle.cpp and
// driveline_rules.cpp.
#pragma once

#include "protocol/files/json_reader.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

inline void check_spec(const BrakeSpec&, const JsonReader&) {}
inline void check_spec(const FixedSpec&, const JsonReader&) {}
inline void check_spec(const WheelShaftSpec&, const JsonReader&) {}

// Each @throws Error(bad_input) naming file, key and what was expected.
void check_spec(const BodySpec&, const JsonReader&);
void check_spec(const SpindleSpec&, const JsonReader&);
void check_spec(const ArmSpec&, const JsonReader&);
void check_spec(const TieRodSpec&, const JsonReader&);
void check_spec(const StopSpec&, const JsonReader&);
void check_spec(const SpringSpec&, const JsonReader&);
void check_spec(const OuterShockSpec&, const JsonReader&);
void check_spec(const ShockSpec&, const JsonReader&);
void check_spec(const DoubleWishboneSpec&, const JsonReader&);
void check_spec(const TrailingArmSpec&, const JsonReader&);
void check_spec(const LinkSpec&, const JsonReader&);
void check_spec(const RigidAxleSpec&, const JsonReader&);
void check_spec(const WheelSpec&, const JsonReader&);
void check_spec(const PitmanArmSpec&, const JsonReader&);
void check_spec(const RackSpec&, const JsonReader&);
void check_spec(const ShaftSpec&, const JsonReader&);
void check_spec(const EngineSpec&, const JsonReader&);
void check_spec(const ConverterSpec&, const JsonReader&);
void check_spec(const ClutchSpec&, const JsonReader&);
void check_spec(const GearboxSpec&, const JsonReader&);
void check_spec(const GearSpec&, const JsonReader&);
void check_spec(const DifferentialSpec&, const JsonReader&);
void check_spec(const MotorSpec&, const JsonReader&);
void check_spec(const DrivelineSpec&, const JsonReader&);

/// Checks rules across the shafts of a driveline: names, carriers, loops, wheels.
void check_driveline(const VehicleSpec& vehicle, const JsonReader& driveline);

}  // namespace furrow::vehicle
