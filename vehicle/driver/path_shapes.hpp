// Paths from the shapes that a driver file may name.
#pragma once

#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/driver/path.hpp"

namespace furrow::vehicle {

/// Waypoints are joined by a curve through all of them. Its direction at each is that of the parabola through it and
/// its neighbours, by the length of the chords; at the ends it is the neighbour's, mirrored on the chord.
/// @param vehicle_width for the lanes of a lane change, m
Path make_path(const PathSpec& spec, double vehicle_width);

}  // namespace furrow::vehicle
