// A shaft: a rotor that turns about an axis fixed in the body that carries it. The shaft holds its angular momentum
// along the axis, p = J Ω; the rest of its mass and inertia is counted with the carrier. Ω is the absolute angular
// speed about the axis, so a torque M about the axis gives J dΩ/dt = M. The reaction −M and the gyroscopic moment −ω ×
// p a act on the carrier.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "vehicle/multibody/body.hpp"

namespace furrow::vehicle {

struct ShaftState {
  double angle = 0.0;  // ∫ Ω dt, rad
  double speed = 0.0;  // Ω, rad/s
};
void visit_fields(FieldsOf<ShaftState> auto& s, auto&& visit) {
  visit(s.angle, Field{"angle", "rad"});
  visit(s.speed, Field{"speed", "rad/s"});
}

struct Shaft {
  std::string name;
  double inertia = 1.0;       // J about the axis, kg m²
  int carrier = kGround;      // the body that holds its bearings
  Vec3 axis = Vec3::UnitX();  // a, unit vector in the carrier's axes
  ShaftState state;
};

}  // namespace furrow::vehicle
