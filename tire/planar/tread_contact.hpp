// The penalty contact (rubbing_contact.hpp) of a planar tire in a run, on ground that is alike across: a profile z(x),
// or level.
//
// The outer nodes in the middle of the width touch the ground in the vertical plane of x and z, so a wheel may steer
// and lean. Forces act in this plane; friction also acts across it, along y. Their part in the wheel's plane moves the
// node, the rest acts on the rim. Each of the two vertices of a node gets half of its force.
#pragma once

#include <memory>

#include "protocol/core/ground_heights.hpp"
#include "tire/extruded/plane_contact.hpp"
#include "tire/planar/rubbing_contact.hpp"

namespace furrow::tire {

/// @param tread nodes in the order of the vertices of cylinder(). @param mass of all nodes, kg
std::unique_ptr<PlaneContact> make_tread_contact(const PlanarMesh& mesh, const std::vector<int>& tread,
                                                 const std::vector<double>& mass, const PlanarContactLaw& law,
                                                 const GroundProfilePoints& ground);

/// Level before the first point and after the last; none: the plane z = 0.
PlanarGround endless_ground(const GroundProfilePoints& points);

}  // namespace furrow::tire
