// The data that rim, tire and terrain exchange: motions, forces, and the triangulated contact surface.
#pragma once

#include <array>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Motion of a rim. The rim's own y axis is the spin axis; forward rolling along +x has a positive spin about +y.
struct RimState {
  Vec3 position = Vec3::Zero();          // rim centre, m, W
  Quat orientation = Quat::Identity();   // R_WR
  Vec3 velocity = Vec3::Zero();          // of the rim centre, m/s, W
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, W
};
void visit_fields(FieldsOf<RimState> auto& s, auto&& visit) {
  visit(s.position, Field{"position", "m"});
  visit(s.orientation, Field{"orientation"});
  visit(s.velocity, Field{"velocity", "m/s"});
  visit(s.angular_velocity, Field{"angular_velocity", "rad/s"});
}

/// Force and moment about the rim centre, W.
struct Wrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};
void visit_fields(FieldsOf<Wrench> auto& s, auto&& visit) {
  visit(s.force, Field{"force", "N"});
  visit(s.moment, Field{"moment", "N m"});
}

/// Connectivity of a contact surface; triangles run counter-clockwise seen from outside the tire.
struct SurfaceMesh {
  int vertex_count = 0;
  std::vector<std::array<int, 3>> triangles;
};
void visit_fields(FieldsOf<SurfaceMesh> auto& s, auto&& visit) {
  visit(s.vertex_count, Field{"vertex_count"});
  visit(s.triangles, Field{"triangles"});
}

/// Vertex positions (m) and velocities (m/s) of a contact surface at one instant, W; length = vertex_count.
struct SurfaceState {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
};
void visit_fields(FieldsOf<SurfaceState> auto& s, auto&& visit) {
  visit(s.position, Field{"position", "m"});
  visit(s.velocity, Field{"velocity", "m/s"});
}

/// How a nodal force responds to the motion of its vertex; all members are means over the interval in which it acted.
/// If the vertex moved differently, the force would be about force − stiffness (x − position) − damping (v − velocity).
struct ContactTangent {
  Mat3 stiffness = Mat3::Zero();  // −∂f/∂x, N/m, W, symmetric, not negative
  Mat3 damping = Mat3::Zero();    // −∂f/∂v, N s/m, W, symmetric, not negative
  Vec3 position = Vec3::Zero();   // of the vertex as the terrain moved it, m
  Vec3 velocity = Vec3::Zero();   // m/s
};
void visit_fields(FieldsOf<ContactTangent> auto& s, auto&& visit) {
  visit(s.stiffness, Field{"stiffness", "N/m"});
  visit(s.damping, Field{"damping", "N s/m"});
  visit(s.position, Field{"position", "m"});
  visit(s.velocity, Field{"velocity", "m/s"});
}

/// Sparse nodal forces on the tire's contact surface, impulse-averaged over one communication interval.
/// Vertices are strictly increasing. force = normal + tangential by construction.
struct NodalForces {
  std::vector<int> vertex;
  std::vector<Vec3> force;                   // N, W, on the tire by the terrain
  std::vector<ContactTangent> tangent = {};  // of each force; empty if none were asked for

  void clear() {
    vertex.clear();
    force.clear();
    tangent.clear();
  }
};
void visit_fields(FieldsOf<NodalForces> auto& s, auto&& visit) {
  visit(s.vertex, Field{"vertex"});
  visit(s.force, Field{"force", "N"});
  visit(s.tangent, Field{"tangent", ""});
}

/// Mass properties of the tire as a rigid body, centre of mass at the rim centre.
struct MassProperties {
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // about the rim centre, rim axes, kg m²
};
void visit_fields(FieldsOf<MassProperties> auto& s, auto&& visit) {
  visit(s.mass, Field{"mass", "kg"});
  visit(s.inertia, Field{"inertia", "kg m²"});
}

/// Elastic and frictional properties of a surface in contact with grains or ground.
struct ContactMaterial {
  double young_modulus = 0.0;      // Pa
  double poisson_ratio = 0.0;      // -
  double friction = 0.0;           // Coulomb coefficient, -
  double restitution = 0.0;        // -, law mindlin
  double normal_stiffness = 0.0;   // N/m^1.5, law hertz_tanh
  double normal_damping = 0.0;     // N s/m^1.5, law hertz_tanh
  double cohesion = 0.0;           // Pa; the tire's is zero
  double pair_friction = -1.0;     // of this surface with grains, -; negative: the smaller friction of the two
  double rolling_friction = -1.0;  // of grains on this surface, -; negative: the value among grains
  double area_density = 0.0;       // mass of the surface that a contact moves, kg/m²; 0: rigid and heavy
};
void visit_fields(FieldsOf<ContactMaterial> auto& s, auto&& visit) {
  visit(s.young_modulus, Field{"young_modulus", "Pa"});
  visit(s.poisson_ratio, Field{"poisson_ratio"});
  visit(s.friction, Field{"friction"});
  visit(s.restitution, Field{"restitution"});
  visit(s.normal_stiffness, Field{"normal_stiffness", "N/m^1.5"});
  visit(s.normal_damping, Field{"normal_damping", "N s/m^1.5"});
  visit(s.cohesion, Field{"cohesion", "Pa"});
  visit(s.pair_friction, Field{"pair_friction"});
  visit(s.rolling_friction, Field{"rolling_friction"});
  visit(s.area_density, Field{"area_density", "kg/m²"});
}

}  // namespace furrow
