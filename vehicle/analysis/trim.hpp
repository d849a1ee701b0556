// The static trim of a vehicle on level ground: its posture at rest on its tires, and its vibrations about it.
//
// A tire is described by its press curve F(δ), the vertical force at a deflection δ = R − z_c/cos γ of a wheel with its
// centre at the height z_c and its axle at the angle γ to the ground. It stores ∫ F dδ, so it pushes the wheel with
// F/cos γ upward at the lowest point of its middle circle. Wheels do not turn, the steering is held straight, and the
// chassis is held in x, y and about z.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "vehicle/parts/vehicle.hpp"

namespace furrow::vehicle {

struct TireCurve {
  double radius = 0.0;                             // R, m
  std::function<double(double deflection)> force;  // F(δ), N; 0 for δ ≤ 0, rising beyond
};

/// A spring or shock absorber at rest.
struct StrutTrim {
  double length = 0.0;  // m
  double force = 0.0;   // pushes its ends apart, N
  double to_shortest = 0.0,
         to_longest = 0.0;  // m to its stops or marks, negative beyond; infinite if it has none
};
void visit_fields(FieldsOf<StrutTrim> auto& s, auto&& visit) {
  visit(s.length, Field{"length", "m"});
  visit(s.force, Field{"force", "N"});
  visit(s.to_shortest, Field{"to_shortest", "m"});
  visit(s.to_longest, Field{"to_longest", "m"});
}

struct WheelTrim {
  std::string name;
  double load = 0.0;               // of the ground on the tire, N
  double deflection = 0.0;         // of the tire, m
  double height = 0.0;             // of the wheel's centre above the ground, m
  Vec3 center = Vec3::Zero();      // of the wheel in the vehicle's frame, m
  double travel = 0.0;             // of the centre from its drawn position, upward, m
  double camber = 0.0, toe = 0.0;  // rad
  std::optional<StrutTrim> spring, shock;
};
void visit_fields(FieldsOf<WheelTrim> auto& s, auto&& visit) {
  visit(s.name, Field{"name", ""});
  visit(s.load, Field{"load", "N"});
  visit(s.deflection, Field{"deflection", "m"});
  visit(s.height, Field{"height", "m"});
  visit(s.center, Field{"center", "m"});
  visit(s.travel, Field{"travel", "m"});
  visit(s.camber, Field{"camber", "rad"});
  visit(s.toe, Field{"toe", "rad"});
  visit(s.spring, Field{"spring", ""});
  visit(s.shock, Field{"shock", ""});
}

/// One vibration. Names by the largest motion: of the body heave, pitch and roll, of the wheels "hop front" (both up)
/// or "tramp front" (one up, one down).
struct TrimMode {
  std::string name;
  double frequency = 0.0;  // undamped, Hz
  double damping = 0.0;    // share of critical, with the mean of the shocks' coefficients for small speeds
};
void visit_fields(FieldsOf<TrimMode> auto& s, auto&& visit) {
  visit(s.name, Field{"name", ""});
  visit(s.frequency, Field{"frequency", "Hz"});
  visit(s.damping, Field{"damping"});
}

struct Trim {
  std::vector<WheelTrim> wheels;   // those of the vehicle
  std::vector<double> axle_loads;  // N
  double height = 0.0;             // of the vehicle's origin above the ground, m
  double pitch = 0.0, roll = 0.0;  // of the chassis, rad; positive: nose down, right side down
  std::vector<TrimMode> modes;     // lowest frequency first
};
void visit_fields(FieldsOf<Trim> auto& s, auto&& visit) {
  visit(s.wheels, Field{"wheels", ""});
  visit(s.axle_loads, Field{"axle_loads", "N"});
  visit(s.height, Field{"height", "m"});
  visit(s.pitch, Field{"pitch", "rad"});
  visit(s.roll, Field{"roll", "rad"});
  visit(s.modes, Field{"modes", ""});
}

/// Brings the vehicle to rest on the plane z = `ground` and returns its posture.
/// @param gravity  m/s², with the vehicle along x; none: the vehicle's own. On a slope, each wheel holds the same share
///                 of the pull along the plane, at its contact point.
/// @pre one tire for each wheel; their masses were added. @throws Error(physics) when there is no equilibrium
Trim trim(Vehicle& vehicle, std::span<const TireCurve> tires, double ground = 0.0,
          const std::optional<Vec3>& gravity = {}, const ProgressCall& progress = {});

/// Keys of stops on which a spring rests, and its distance beyond them: the wheel has no travel left. Only one of an
/// axle's two wheels is listed.
std::vector<std::pair<std::string, std::string>> stops_at_rest(const VehicleSpec& spec, const Trim& trim);

}  // namespace furrow::vehicle
