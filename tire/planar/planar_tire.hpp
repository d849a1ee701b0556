// The planar finite-element tire in motion under the interface of all tires.
//
// In its plane the tire is that of planar_carcass.hpp: its inner nodes move with the rim, which stands for the disc.
// The plane is spanned by a × z, horizontal, and by what is normal to it and to the rim's axis a. Across the plane the
// tire is the rigid body that its mass properties say: it shifts, turns and leans with the rim, and gyroscopic moments
// are those of its own spin. Axes that turn while an interval lasts are those of its middle; Coriolis forces of a plane
// that turns are left out.
//
// The contact surface is the outer edge, drawn out over the width: vertices on both sides of a node, which get forces
// of their own and act on it by their sum. Forces of an interval act constantly over it, at the nodes.
#pragma once

#include <memory>

#include "tire/planar/planar_file.hpp"

namespace furrow::tire {

/// Where a spin axis stands in a wheel's plane and around it.
struct WheelPlane {
  Vec3 forward, up, axis;  // unit vectors, W
  Vec3 out(double x, double z) const { return x * forward + z * up; }
  PlanarPoint in(const Vec3& v) const { return {forward.dot(v), up.dot(v)}; }
  /// @pre the rim's axis is not vertical
  static WheelPlane of(const Quat& rim);
  /// By which a rim is turned about its axis, rad.
  double angle(const Quat& rim) const;
};

/// Mass, and inertia about the centre, of the undeformed tire without its disc: those of the nodes.
MassProperties planar_mass(const PlanarParams& params);

/// @pre semi-implicit Euler
std::unique_ptr<Tire> make_planar_tire(const PlanarFile& file, TireShape shape, const Vec3& gravity);

}  // namespace furrow::tire
