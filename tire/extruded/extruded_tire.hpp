// Moving tires whose section does not change across their width, with the interface of all tires.
//
// In its plane the tire is a PlaneModel on the rim (plane_model.hpp). Across the plane (wheel_plane.hpp) the tire is a
// rigid body with its mass properties: it shifts, turns and leans with the rim, and gyroscopic moments come from its
// own spin. Axes that turn during an interval are taken at its middle. The additional inertial forces of a turning
// plane act on the rim, by the balance of momentum, and do not deform the tire.
//
// The contact surface is the outer edge, extruded over the width. Each node has a vertex on both sides; each vertex
// gets its own force, and their sum acts on the node. Forces are constant over an interval, except those of a model
// with a contact of its own (plane_contact.hpp): the tire states their means over the interval.
#pragma once

#include <memory>

#include "tire/extruded/plane_model.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// @pre the shape is that of cylinder(), with as many facets as the model has nodes on its tread
std::unique_ptr<Tire> make_extruded_tire(std::unique_ptr<PlaneModel> model, TireShape shape, const Vec3& gravity);

}  // namespace furrow::tire
