// Largest magnitudes that a vehicle file may state, far beyond those of any vehicle: what is larger is a slip of the
// pen. data/vehicle.schema.json states the same.
#pragma once

namespace furrow::vehicle::most {

inline constexpr double kMass = 1e7;            // of a body, kg: the largest excavators
inline constexpr double kGyration = 100.0;      // radius of gyration of a body, m: that of points from their origin
inline constexpr double kShaftInertia = 1e6;    // kg m²
inline constexpr double kTorque = 1e8;          // of a brake, a clutch, a lock or a motor, N m
inline constexpr double kRate = 1e10;           // of a spring, N/m
inline constexpr double kDamping = 1e8;         // N s/m
inline constexpr double kRpm = 1e6;             // of engines, motors and marks of gearboxes
inline constexpr double kWheelAngle = 45.0;     // camber and toe, degrees
inline constexpr double kResponseTime = 100.0;  // of a steering, s
inline constexpr double kTravel = 10.0;         // of a rack, m

}  // namespace furrow::vehicle::most
