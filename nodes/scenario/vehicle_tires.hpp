// A vehicle's file outside a scenario, and its tires at rest, each pressed on flat ground.
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

/// Finds `name` as it is, or in vehicle/data/. @throws Error(bad_input) naming the places searched
std::filesystem::path find_vehicle(const std::string& name);

/// Like find_vehicle(), for a command that accepts only vehicles. @throws Error(bad_input) for a scenario, naming its
/// vehicle
std::filesystem::path find_vehicle_alone(const std::string& name);

/// Checks whether `name` is a file that describes a vehicle: it has axles or a chassis, which a scenario never has.
bool is_vehicle(const std::string& name);

/// The tires named in a vehicle's file, one for each wheel; wheels with the same tire share it. Their meshes are
/// coarse, so that pressing takes seconds. @throws Error(bad_input) naming file and key
std::vector<std::shared_ptr<const tire::TireSpec>> tires_of(const vehicle::VehicleSpec& vehicle);

/// Presses each tire at rest up to more than its share of the weight; tire/press/press_curve.hpp states the cost.
/// @pre one tire for each wheel. @throws Error
std::vector<vehicle::StandingTire> standing_tires(const vehicle::VehicleSpec& vehicle,
                                                  std::span<const std::shared_ptr<const tire::TireSpec>> tires,
                                                  const ProgressCall& progress);

}  // namespace furrow::scenario
