// Keys that several parts of a vehicle share, and the shapes of their values.
#pragma once

#include "protocol/core/key.hpp"

namespace furrow::vehicle {

namespace keys {

inline constexpr Allowed kPoint = allowed::shaped(
    R"({"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number", "minimum": -100, "maximum": 100}})");
inline constexpr Allowed kTable = allowed::shaped(
    R"({"type": "array", "minItems": 2,
        "items": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number"}}})");
inline constexpr Allowed kPart =
    allowed::shaped(R"({"type": "string", "enum": ["lower_arm", "upper_arm", "upright", "arm", "housing"]})");

inline constexpr Key kMass = needed("mass", "kg", allowed::above(0).to(1e7), "Mass.");
inline constexpr Key kCenterOfMass =
    needed("center_of_mass", "m", kPoint,
           "Centre of mass, from the axle's origin; that of the chassis from the vehicle's origin.");
inline constexpr Key kInertia =
    needed("inertia", "kg m²",
           allowed::shaped(R"({"type": "array", "minItems": 3, "maxItems": 6, "items": {"type": "number"}})"),
           "Moments of inertia xx, yy, zz, or xx, yy, zz, xy, xz, yz; no principal moment above the sum of the other "
           "two, and a "
           "radius of gyration of at most 100 m.");
inline constexpr Key kChassisEnd = needed("chassis", "m", kPoint, "End on the chassis, from the axle's origin.");
inline constexpr Key kEnd = needed("end", "m", kPoint, "End on the suspension, from the axle's origin.");
inline constexpr Key kOn =
    key("on", "", kPart,
        "Part of the suspension that carries this end: lower_arm (default), upper_arm or upright "
        "of double wishbones; arm of a trailing arm; housing of a rigid axle.");
inline constexpr Key kCompression = needed("compression", "N s/m", allowed::from(0, 1e8), "Damping in compression.");
inline constexpr Key kRebound = needed("rebound", "N s/m", allowed::from(0, 1e8), "Damping in rebound.");
inline constexpr Key kResponseTime =
    key("response_time", "s", allowed::above(0).to(100), "Time constant with which the steering follows the driver.");
inline constexpr Key kIn = needed("in", "", allowed::not_empty(), "Input shaft.");
inline constexpr Key kOut = needed("out", "", allowed::not_empty(), "Output shaft.");

}  // namespace keys
}  // namespace furrow::vehicle
