// Values of bodies, shock absorbers, brakes, wheels and steerings that no rule forbids but that are hardly intended.
// Each is compared with the mass and the size of the whole vehicle.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// Keys, and what is odd about their values. The right side is listed only if its problem differs from the left side's.
/// @param mass of the whole vehicle without tires, kg
/// @pre mass > 0
std::vector<std::pair<std::string, std::string>> unlikely_parts(const VehicleSpec& spec, double mass);

/// Key of the heaviest body, and its mass, kg.
std::pair<std::string, double> heaviest_body(const VehicleSpec& spec);

/// Refuses a vehicle that is much too heavy for a tire, with the key of its heaviest body.
/// @param mass of the whole vehicle, kg @param most load that the tire cannot carry, N
/// @throws Error(bad_input)
void check_load(const VehicleSpec& spec, double mass, const std::string& tire, double most);

/// Refuses a chassis whose centre of mass is not above the ground on which the tires stand.
/// @param radii of the tires, m
/// @throws Error(bad_input)
void check_height(const VehicleSpec& spec, std::span<const double> radii);

/// Largest distance between the centres of two wheels, m.
double size_of(const VehicleSpec& spec);

}  // namespace furrow::vehicle
