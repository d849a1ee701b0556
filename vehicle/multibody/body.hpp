// A rigid body in maximal coordinates; its reference point is the centre of mass.
#pragma once

#include <string>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::vehicle {

inline constexpr int kGround = -1;  // index of the fixed world instead of a body

struct BodyState {
  Vec3 position = Vec3::Zero();          // centre of mass, m, W
  Quat orientation = Quat::Identity();   // R_WB
  Vec3 velocity = Vec3::Zero();          // m/s, W
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, W
};
void visit_fields(FieldsOf<BodyState> auto& s, auto&& visit) {
  visit(s.position, Field{"position", "m"});
  visit(s.orientation, Field{"orientation"});
  visit(s.velocity, Field{"velocity", "m/s"});
  visit(s.angular_velocity, Field{"angular_velocity", "rad/s"});
}

struct Body {
  std::string name;
  double mass = 1.0;                        // kg
  Mat3 inertia = Mat3::Identity();          // about the centre of mass, body axes, kg m²
  Mat3 inertia_inverse = Mat3::Identity();  // body axes
  BodyState state;
  Vec3 angular_momentum = Vec3::Zero();  // R J Rᵀ ω, W, kg m²/s; integrated instead of ω
  Vec3 force = Vec3::Zero();             // external, W, N
  Vec3 moment = Vec3::Zero();            // external, about the centre of mass, W, N m

  Mat3 R = Mat3::Identity();                  // of state.orientation
  Mat3 inertia_inverse_W = Mat3::Identity();  // R J⁻¹ Rᵀ

  /// Computes R and R J⁻¹ Rᵀ from the orientation.
  void refresh() {
    R = state.orientation.toRotationMatrix();
    inertia_inverse_W = R * inertia_inverse * R.transpose();
  }
};
/// The part of a body that a saved state keeps. The rest follows from it, or is set when the system is built.
void visit_fields(FieldsOf<Body> auto& s, auto&& visit) {
  visit(s.state, Field{"state", ""});
  visit(s.angular_momentum, Field{"angular_momentum", "kg m²/s"});
}

}  // namespace furrow::vehicle
