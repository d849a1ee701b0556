// Keys of the section `rig` that several kinds of rig share, and the options of a rig on a rail.
#pragma once

#include "protocol/core/key.hpp"

namespace furrow::rigs::keys {

inline constexpr Key kSpeed = key("speed", "m/s", allowed::from(0, 1000).usual(0.05, 50),
                                  "Speed of the carriage, modes fixed_speed and free_rolling.");
inline constexpr Key kRamp = key("ramp", "s", allowed::from(0, 1e4),
                                 "Duration of the smooth start of both motions from rest. 0: full speed from t = 0.");
inline constexpr Key kMoveFrom = key("move_from", "s", allowed::from(0, 1e5),
                                     "When both motions begin. Until then the wheel is lowered and stands, as in a "
                                     "laboratory. 0: it moves from the start and lands while it moves.");
inline constexpr Key kTouchdownTime = key("touchdown_time", "s", allowed::from(0, 1e4).or_null(),
                                          "How long the damper of touchdown_damping acts. null: until move_from, or "
                                          "1.6 √(R/g) if that is 0 and for vehicles.");
inline constexpr Key kLoweringSpeed =
    key("lowering_speed", "m/s", allowed::above(0).to(100).or_null(),
        "Speed at which the damper lowers the wheel, in place of touchdown_damping; the wheel slows down as the ground "
        "takes over its load. A vehicle is lowered by a damper above its chassis. null: 0.18 √(g R); a vehicle with a "
        "drop_height falls.");
inline constexpr Key kStart = key("start", "m", allowed::from(-1e6, 1e6).or_null(),
                                  "Place along x of the axle, of a half car's front axle, or of the origin of a "
                                  "vehicle's frame, at t = 0. null: just clear of the wall behind.");
inline constexpr Key kLoad =
    key("load", "N", allowed::above(0).to(1e7).usual(1, 200000).or_null(),
        "Weight on the ground of all that the wheel carries: carrier, rim and tire. The carrier's mass follows from "
        "it. Give load or carrier_mass, not both. null: as the masses say.");
inline constexpr Key kCarrierMass = key("carrier_mass", "kg", allowed::above(0).to(1e6).usual(0.1, 20000).or_null(),
                                        "Mass of the wheel carrier with its ballast, carried by the soil. null: from "
                                        "load, or as the tire file's block `rim` says.");
inline constexpr Key kRimMass =
    key("rim_mass", "kg", allowed::above(0).to(1e5).usual(0.01, 2000).or_null(),
        "Mass of the rim with its spindle, without the tire. null: as the tire file's block `rim` says.");
inline constexpr Key kRimSpinInertia =
    key("rim_spin_inertia", "kg m²", allowed::above(0).to(1e5).or_null(),
        "Moment of inertia of the rim about its axle, without the tire. null: as the tire file's block `rim` says.");
inline constexpr Key kRimDiametralInertia =
    key("rim_diametral_inertia", "kg m²", allowed::above(0).to(1e5).or_null(),
        "Moment of inertia of the rim about a diameter, without the tire. null: as the tire file's block `rim` says, "
        "or half of the spin inertia.");
inline constexpr Key kBodyMass =
    key("body_mass", "kg", allowed::above(0).to(1e6).usual(0.1, 20000).or_null(),
        "Sprung mass of a quarter car or a half car. Give load or body_mass, not both. null: from load, or the "
        "carrier_mass of the tire file's block `rim`, of a half car the sum of both.");
inline constexpr Key kUnsprungMass = key(
    "unsprung_mass", "kg", allowed::above(0).to(1e5).usual(0.001, 2000).or_null(),
    "Mass of each wheel carrier of a quarter car or a half car, beside rim and tire. null: a hundredth of the rim.");
inline constexpr Key kSuspensionStiffness = key(
    "suspension_stiffness", "N/m", allowed::from(0, 1e9).usual(10, 1e6).or_null(),
    "Spring between body and wheel of a quarter car, or between body and front wheel of a half car. The spring's free "
    "length is chosen so that it carries the body at the height where it was placed. null: the body at 1.5 Hz.");
inline constexpr Key kSuspensionDamping =
    key("suspension_damping", "N s/m", allowed::from(0, 1e8).usual(0.1, 1e5).or_null(),
        "Damper between body and wheel of a quarter car, or between body and front wheel of a half car. null: 0.3 of "
        "the body's critical damping.");

}  // namespace furrow::rigs::keys

namespace furrow::rigs {

/// Options of a rig whose trolley runs along a rail. A negative value is open: the scenario does not give it.
struct RailOptions {
  double speed = 4.0;                   // of the trolley, m/s
  double ramp = 0.15;                   // smooth (C²) start from rest, s; 0: full speed from t = 0
  double move_from = 0.0;               // when it starts, s; until then the wheels are lowered and do not roll
  double touchdown_time = -1.0;         // how long the damper lowers the wheels, s
  double lowering_speed = -1.0;         // at which the damper lowers the wheels, m/s
  double start = 0.0;                   // x of the (front) axle at t = 0, m; filled in if the scenario does not give it
  double load = -1.0;                   // weight of all that the ground carries, tires included, N
  double rim_mass = -1.0;               // of each rim, kg
  double rim_spin_inertia = -1.0;       // kg m², about the axle
  double rim_diametral_inertia = -1.0;  // kg m²
};

}  // namespace furrow::rigs
