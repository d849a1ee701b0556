// The driver of a driver file. Each of its four parts follows a table of time or closes a loop:
//
//   pedals    tables, or a speed held by a PI law (speed_control.hpp)
//   steering  a table, or a path followed by looking ahead (path_follower.hpp)
//   gear      a table, or left to the gearbox
//   lock      a table
#pragma once

#include <memory>

#include "vehicle/driver/driver.hpp"
#include "vehicle/driver/driver_spec.hpp"

namespace furrow::vehicle {

/// @pre all members of the car are positive
std::unique_ptr<Driver> make_driver(const DriverSpec& spec, const DriverCar& car);

}  // namespace furrow::vehicle
