// A whole vehicle as a rig: it carries its tires, a driver drives it, and nothing else holds it.
//
// Start: in the trim of hard level ground (vehicle_start.hpp), turned to its heading, each tire just above the surface.
// Where the ground under its wheels slopes by more than 0.02 rad, all of it is tilted onto that slope.
// A damper above the chassis, c = weight/lowering_speed, lets it down until touchdown_time;
// with lowering_speed 0 it falls.
//
// Slip of a wheel: 1 − v/(ω r) with the speed v of its centre along its own heading. The slip is 0 while both |v| and
// |ω r| are below 0.01 √(g r).
#pragma once

#include <memory>

#include "rigs/rig.hpp"
#include "rigs/vehicle/vehicle_options.hpp"

namespace furrow::rigs {

/// @pre lowering_speed and touchdown_time are given
std::unique_ptr<Rig> make_vehicle_rig(const VehicleRigPlan& plan);

}  // namespace furrow::rigs
