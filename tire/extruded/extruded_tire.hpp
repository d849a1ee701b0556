// Tires that are alike across their width in motion, under the interface of all tires.
//
// In its plane the tire is a PlaneModel on the rim (plane_model.hpp). Across the plane (wheel_plane.hpp) the tire is
// the rigid body that its mass properties say: it shifts, turns and leans with the rim, and gyroscopic moments are
// those of its own spin. Axes that turn while an interval lasts are those of its middle. What a plane that turns adds
// to the forces of its plane's own motion goes to the rim, by the balance of momentum, and does not deform the tire.
//
// The contact surface is the outer edge, drawn out over the width: vertices on both sides of a node, which get forces
// of their own and act on it by their sum. Forces of an interval act constantly over it, at the nodes.
#pragma once

#include <memory>

#include "tire/extruded/plane_model.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// @pre the shape is that of cylinder(), with as many facets as the model has nodes on its tread
std::unique_ptr<Tire> make_extruded_tire(std::unique_ptr<PlaneModel> model, TireShape shape, const Vec3& gravity);

}  // namespace furrow::tire
