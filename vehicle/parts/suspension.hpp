// Adds the bodies and joints of an axle's spec to a system.
#pragma once

#include <array>

#include "vehicle/multibody/system.hpp"
#include "vehicle/parts/suspension_kinds.hpp"
#include "vehicle/spec/vehicle_spec.hpp"

namespace furrow::vehicle {

/// @param chassis body @param rods body that holds the tie rods' inner ends: the chassis, a link or a rack
std::array<Wheel, 2> add_axle(System& system, const AxleSpec& axle, int index, int chassis, int rods,
                              const std::array<Wheel, 2>* host);

}  // namespace furrow::vehicle
