// Paths from the shapes of driver files.
#pragma once

#include "vehicle/driver/driver_spec.hpp"
#include "vehicle/driver/path.hpp"

namespace furrow::vehicle {

/// A curve joins all waypoints. Its direction at each waypoint is that of the parabola through this point and its
/// neighbours, as a function of the chords' lengths. At the ends it is the neighbour's direction, mirrored on the
/// chord.
/// @param vehicle_width for the lanes of a lane change, m
Path make_path(const PathSpec& spec, double vehicle_width);

}  // namespace furrow::vehicle
