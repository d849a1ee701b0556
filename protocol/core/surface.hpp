// What crosses between rim, tire and terrain: motions, forces, and the triangulated contact surface.
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
void visit_fields(auto&& visit, FieldsOf<RimState> auto& s) {
  visit(Field{"position", "m"}, s.position);
  visit(Field{"orientation"}, s.orientation);
  visit(Field{"velocity", "m/s"}, s.velocity);
  visit(Field{"angular_velocity", "rad/s"}, s.angular_velocity);
}

/// Force and moment about the rim centre, W.
struct Wrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};
void visit_fields(auto&& visit, FieldsOf<Wrench> auto& s) {
  visit(Field{"force", "N"}, s.force);
  visit(Field{"moment", "N m"}, s.moment);
}

/// Connectivity of a contact surface; triangles run counter-clockwise seen from outside the tire.
struct SurfaceMesh {
  int vertex_count = 0;
  std::vector<std::array<int, 3>> triangles;
};
void visit_fields(auto&& visit, FieldsOf<SurfaceMesh> auto& s) {
  visit(Field{"vertex_count"}, s.vertex_count);
  visit(Field{"triangles"}, s.triangles);
}

/// Vertex positions (m) and velocities (m/s) of a contact surface at one instant, W; length = vertex_count.
struct SurfaceState {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
};
void visit_fields(auto&& visit, FieldsOf<SurfaceState> auto& s) {
  visit(Field{"position", "m"}, s.position);
  visit(Field{"velocity", "m/s"}, s.velocity);
}

/// How a nodal force answers to the motion of its vertex, means over the interval in which it acted: over an interval
/// in which the vertex moves otherwise it would be about force − stiffness (x − position) − damping (v − velocity).
struct ContactTangent {
  Mat3 stiffness = Mat3::Zero();  // −∂f/∂x, N/m, W, symmetric, not negative
  Mat3 damping = Mat3::Zero();    // −∂f/∂v, N s/m, likewise
  Vec3 position = Vec3::Zero();   // of the vertex as the terrain moved it, m
  Vec3 velocity = Vec3::Zero();   // m/s
};
void visit_fields(auto&& visit, FieldsOf<ContactTangent> auto& s) {
  visit(Field{"stiffness", "N/m"}, s.stiffness);
  visit(Field{"damping", "N s/m"}, s.damping);
  visit(Field{"position", "m"}, s.position);
  visit(Field{"velocity", "m/s"}, s.velocity);
}

/// Sparse nodal forces on the tire's contact surface, impulse-averaged over one communication interval.
/// Vertices are strictly increasing. force = normal + tangential by construction.
struct NodalForces {
  std::vector<int> vertex;
  std::vector<Vec3> force;                   // N, W, on the tire by the terrain
  std::vector<ContactTangent> tangent = {};  // of each force; empty: none were asked for

  void clear() {
    vertex.clear();
    force.clear();
    tangent.clear();
  }
};
void visit_fields(auto&& visit, FieldsOf<NodalForces> auto& s) {
  visit(Field{"vertex"}, s.vertex);
  visit(Field{"force", "N"}, s.force);
  visit(Field{"tangent", ""}, s.tangent);
}

/// Mass properties of the tire as a rigid body, centre of mass at the rim centre.
struct MassProperties {
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // about the rim centre, rim axes, kg m²
};
void visit_fields(auto&& visit, FieldsOf<MassProperties> auto& s) {
  visit(Field{"mass", "kg"}, s.mass);
  visit(Field{"inertia", "kg m²"}, s.inertia);
}

/// Elastic and frictional properties of a surface for contact with grains or ground.
struct ContactMaterial {
  double young_modulus = 0.0;     // Pa
  double poisson_ratio = 0.0;     // -
  double friction = 0.0;          // Coulomb coefficient, -
  double restitution = 0.0;       // -, law mindlin
  double normal_stiffness = 0.0;  // N/m^1.5, law hertz_tanh
  double normal_damping = 0.0;    // N s/m^1.5, law hertz_tanh
  double cohesion = 0.0;          // Pa; the tire's is zero
  double area_density = 0.0;      // mass of the surface that a contact moves, kg/m²; 0: a rigid, heavy one
};
void visit_fields(auto&& visit, FieldsOf<ContactMaterial> auto& s) {
  visit(Field{"young_modulus", "Pa"}, s.young_modulus);
  visit(Field{"poisson_ratio"}, s.poisson_ratio);
  visit(Field{"friction"}, s.friction);
  visit(Field{"restitution"}, s.restitution);
  visit(Field{"normal_stiffness", "N/m^1.5"}, s.normal_stiffness);
  visit(Field{"normal_damping", "N s/m^1.5"}, s.normal_damping);
  visit(Field{"cohesion", "Pa"}, s.cohesion);
  visit(Field{"area_density", "kg/m²"}, s.area_density);
}

}  // namespace furrow
