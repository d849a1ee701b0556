// The planar finite-element tire in motion: planar_carcass.hpp, extruded over its width
// (tire/extruded/extruded_tire.hpp). Its inner nodes move with the rim, which replaces the disc.
#pragma once

#include <memory>

#include "tire/planar/planar_file.hpp"

namespace furrow::tire {

/// Mass, and inertia about the centre, of the nodes of the undeformed tire without its disc.
MassProperties planar_mass(const PlanarParams& params);

/// @pre the file's integrator is semi-implicit Euler
std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity);

}  // namespace furrow::tire
