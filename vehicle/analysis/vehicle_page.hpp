// What there is to know of a vehicle before it drives: bodies and rows, masses, and how it stands on its tires.
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
  std::string text;  // for people: its file, and where its curve is from
  MassProperties mass;
  double radius = 0.0;                            // inflated, m
  std::vector<std::pair<double, double>> points;  // of its press curve (tire_curve.hpp); none: it does not deflect
};

struct VehiclePage {
  std::string name, file;
  double mass = 0.0;                              // without tires, kg
  int bodies = 0, rows = 0, freedoms = 0;         // of bodies, rows of joints, what these leave
  int shafts = 0, shaft_freedoms = 0;             // what gears and differentials leave of the shafts
  std::vector<std::string> axles, tires;          // of each axle, of each wheel
  std::vector<double> tire_masses, loaded_radii;  // of each wheel, kg; under its load, m
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
  visit(s.trim, Field{"trim", ""});
}

/// Of all its bodies, kg. @throws Error(bad_input) naming the vehicle's file when it cannot be built
double mass_without_tires(const VehicleSpec& spec);

/// Builds the vehicle and lets it stand. Of a vehicle with a tire that does not deflect only those vibrations are
/// listed that do not depend on how hard the ground below it is.
/// @pre one tire for each wheel. @throws Error(bad_input) naming the vehicle's file when it cannot be built or stand
/// @param progress told from the beginning of each phase on; of a vehicle of many axles they take long; may throw to
/// stop it
VehiclePage vehicle_page(const VehicleSpec& spec, std::span<const StandingTire> tires,
                         const ProgressCall& progress = {});

nlohmann::ordered_json page_json(const VehiclePage& page);
std::string page_text(const VehiclePage& page);

}  // namespace furrow::vehicle
