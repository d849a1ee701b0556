// The tire's axes on the ground (ISO-W), the usual axes for forces and moments of tires:
//
//   origin C: the contact centre, where wheel plane, ground plane and the plane through the spin axis that stands on
//     the ground meet; z up, normal to the ground; x forward, along the line in which wheel and ground plane meet;
//     y = z × x.
//
// These are the "tyre axis system" of ISO 8855:2011, the "wheel axis system" of ISO 8855:1991 and the W-axes of TYDEX.
// With a the spin axis towards the left of travel, r the wheel centre, g a point of the ground:
//
//   x = a × z/|a × z|,   C = r − ρ (x × a),   loaded radius ρ = (r − g)·z/(x × a)·z
//
// Slip angle: from x to the velocity of the wheel centre, about z. A velocity component along +y gives a positive angle
// and a negative lateral force. Camber (inclination) angle: of the wheel plane about x; positive leans the top to −y.
#pragma once

#include "protocol/core/surface.hpp"

namespace furrow::tire {

struct GroundPlane {
  Vec3 at = Vec3::Zero();       // a point of it, W, m
  Vec3 normal = Vec3::UnitZ();  // unit, upwards
};

struct WheelAxes {
  Vec3 origin = Vec3::Zero();  // contact centre C, W, m
  Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  double slip_angle = 0.0;     // rad, in (−π/2, π/2); 0 at rest
  double camber_angle = 0.0;   // rad
  double loaded_radius = 0.0;  // from wheel centre to contact centre, m

  Vec3 ground = Vec3::Zero();  // a point of the ground plane, W, m

  double height(const Vec3& at) const { return (at - ground).dot(z); }  // above the ground plane, m
  Vec3 turn(const Vec3& v) const { return {x.dot(v), y.dot(v), z.dot(v)}; }
  /// Force and moment about the contact centre, in these axes, from a wrench whose moment is taken about `about`, W.
  Wrench wrench(const Vec3& force, const Vec3& moment, const Vec3& about) const;
};

/// @param travel unit vector of the direction of travel, W
/// @pre the spin axis is neither normal to the ground nor along `travel`
WheelAxes wheel_axes(const RimState& rim, const Vec3& travel, const GroundPlane& ground);
/// @param ground height of a horizontal plane, m
WheelAxes wheel_axes(const RimState& rim, const Vec3& travel, double ground);

}  // namespace furrow::tire
