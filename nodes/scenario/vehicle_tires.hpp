// A vehicle's file beside the program, and the tires that it stands on: each pressed on flat ground.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "tire/tire_spec.hpp"
#include "vehicle/analysis/vehicle_page.hpp"

namespace furrow::scenario {

/// `name` as it stands, or in vehicle/data/. @throws Error(bad_input) naming the places where it was looked for
std::filesystem::path find_vehicle(const std::string& name);

/// As find_vehicle(), for a command that takes nothing else. @throws Error(bad_input) of a scenario, naming its vehicle
std::filesystem::path find_vehicle_alone(const std::string& name);

/// Whether `name` is a file that describes a vehicle, by what it holds: it has axles or a
/// chassis, which no scenario has.
bool is_vehicle(const std::string& name);

/// The tires that the file of a vehicle names, one for each wheel; wheels of the same tire share it. With coarse
/// meshes, which are pressed within seconds. @throws Error(bad_input) naming file and key
std::vector<std::shared_ptr<const tire::TireSpec>> tires_of(const vehicle::VehicleSpec& vehicle);

/// Each tire at rest, pressed up to more than its share of the weight; see
/// tire/press/press_curve.hpp for what that costs.
/// @pre one tire for each wheel. @throws Error
std::vector<vehicle::StandingTire> standing_tires(const vehicle::VehicleSpec& vehicle,
                                                  std::span<const std::shared_ptr<const tire::TireSpec>> tires,
                                                  const ProgressCall& progress);

}  // namespace furrow::scenario
