// Properties of a vehicle before it drives: bodies and rows, masses, and its posture on its tires.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "protocol/core/progress_call.hpp"
#include "vehicle/analysis/trim.hpp"

namespace furrow::vehicle {

/// The tire of a wheel.
struct StandingTire {
  std::string text;  // for people: its file, and the origin of its curve
  MassProperties mass;
  double radius = 0.0;                            // inflated, m
  std::vector<std::pair<double, double>> points;  // of its press curve (tire_curve.hpp); empty: it does not deflect
};

/// Motion of the wheels at one speed of the engine, or of wheel motors.
struct GearSpeed {
  std::string gear;  // "gear 1", "motors without load"
  double engine_rpm = 0.0;
  double speed = 0.0;  // of the slowest driven wheel, rolling without slip on its loaded radius, m/s
};
void visit_fields(FieldsOf<GearSpeed> auto& s, auto&& visit) {
  visit(s.gear, Field{"gear", ""});
  visit(s.engine_rpm, Field{"engine_rpm", "rpm"});
  visit(s.speed, Field{"speed", "m/s"});
}

struct VehiclePage {
  std::string name, file;
  double mass = 0.0;                              // without tires, kg
  int bodies = 0, rows = 0, freedoms = 0;         // bodies, rows of joints, remaining freedoms
  int shafts = 0, shaft_freedoms = 0;             // shafts, and their freedoms after gears and differentials
  std::vector<std::string> axles, tires;          // of each axle, of each wheel
  std::vector<double> tire_masses, loaded_radii;  // of each wheel, kg; under its load, m
  Vec3 center_of_mass = Vec3::Zero();             // with its tires, as drawn, in the vehicle's frame, m
  double center_height = 0.0;                     // height of the centre of mass above the ground, at rest, m
  double wheelbase = 0.0;                         // between first and last axle, at rest, m
  std::vector<double> tracks;                     // of each axle, between wheel centres, at rest, m
  // Mean track over twice the height of the centre of mass: the lateral acceleration over g at which a rigid vehicle
  // would tip [Transportation Research Board, Special Report 265, 2002, https://doi.org/10.17226/10308].
  double static_stability_factor = 0.0;
  std::vector<double> full_steering;   // of each axle (kinematics.hpp), rad
  std::vector<double> damping_ratios;  // of each wheel at rest (kinematics.hpp)
  std::vector<GearSpeed> gear_speeds;  // at the highest speed at which the engine drives
  Trim trim;
};
void visit_fields(FieldsOf<VehiclePage> auto& s, auto&& visit) {
  visit(s.name, Field{"name", ""});
  visit(s.file, Field{"file", ""});
  visit(s.mass, Field{"mass", "kg"});
  visit(s.bodies, Field{"bodies", ""});
  visit(s.rows, Field{"rows", ""});
  visit(s.freedoms, Field{"freedoms", ""});
  visit(s.shafts, Field{"shafts", ""});
  visit(s.shaft_freedoms, Field{"shaft_freedoms", ""});
  visit(s.axles, Field{"axles", ""});
  visit(s.tires, Field{"tires", ""});
  visit(s.tire_masses, Field{"tire_masses", "kg"});
  visit(s.loaded_radii, Field{"loaded_radii", "m"});
  visit(s.center_of_mass, Field{"center_of_mass", "m"});
  visit(s.center_height, Field{"center_height", "m"});
  visit(s.wheelbase, Field{"wheelbase", "m"});
  visit(s.tracks, Field{"tracks", "m"});
  visit(s.static_stability_factor, Field{"static_stability_factor"});
  visit(s.full_steering, Field{"full_steering", "rad"});
  visit(s.damping_ratios, Field{"damping_ratios"});
  visit(s.gear_speeds, Field{"gear_speeds", ""});
  visit(s.trim, Field{"trim", ""});
}

/// Mass of all bodies, kg. @throws Error(bad_input) naming the vehicle's file when it cannot be built
double mass_without_tires(const VehicleSpec& spec);

/// Builds the vehicle and computes its trim. If a tire does not deflect, only vibrations that do not depend on the
/// ground's stiffness are listed.
/// @pre one tire for each wheel. @throws Error(bad_input) naming the vehicle's file when it cannot be built or stand
/// @param progress called from the beginning of each phase on, as phases take long for a vehicle with many axles; may
/// throw to stop
VehiclePage vehicle_page(const VehicleSpec& spec, std::span<const StandingTire> tires,
                         const ProgressCall& progress = {});

/// Keys of steerings in front of the centre of mass that turn their wheels right when the driver steers left.
std::vector<std::pair<std::string, std::string>> steers_against(const VehicleSpec& spec, const VehiclePage& page);

nlohmann::ordered_json page_json(const VehiclePage& page);
std::string page_text(const VehiclePage& page);

}  // namespace furrow::vehicle
