// The planar finite-element tire in motion: planar_carcass.hpp, extruded over its width
// (tire/extruded/extruded_tire.hpp).
#pragma once

#include <memory>

#include "tire/planar/planar_file.hpp"

namespace furrow::tire {

/// Mass, and inertia about the centre, of the nodes of the undeformed tire, with its disc where that is elastic.
MassProperties planar_mass(const PlanarParams& params);

/// @param ground of the tire's own contact, if it has that
std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity,
                                       const GroundProfilePoints& ground = {});

}  // namespace furrow::tire
