// The contact of an extruded tire with ground that it knows by itself, computed in each of the tire's own steps.
#pragma once

#include "protocol/core/stated_contact.hpp"
#include "tire/extruded/wheel_plane.hpp"

namespace furrow::tire {

/// Where the wheel's plane is, and how it moves across itself.
struct PlaneFrame {
  WheelPlane plane;
  Vec3 centre = Vec3::Zero();   // of the rim, m
  Vec3 lateral = Vec3::Zero();  // velocity along the axis, m/s
  Vec3 tilt = Vec3::Zero();     // ω without its part about the axis, rad/s
};

class PlaneContact {
 public:
  virtual ~PlaneContact() = default;

  /// Begins an interval: clears the sums.
  virtual void begin() = 0;
  /// Positions are relative to this frame's centre from now on.
  virtual void place(const PlaneFrame& frame) = 0;
  /// Adds the forces on nodes in the wheel's plane, and sums all forces for `time`.
  /// @param x, v positions from the frame's centre, m, and velocities, m/s, of all nodes. @param step by which the law
  /// limits its forces, s
  virtual void add(const PlanarField& x, const PlanarField& v, double step, double time, PlanarField& force) = 0;
  /// Mean forces of an interval on the vertices of cylinder(), and the contact's energy in this shape.
  virtual void state(const PlanarField& x, double duration, StatedContact& out) = 0;
};

}  // namespace furrow::tire
