// What crosses between rim, tire and terrain: motions, forces, and the triangulated contact surface.
#pragma once

#include <array>
#include <vector>

#include "protocol/core/vec.hpp"

namespace furrow {

/// Motion of a rim. The rim's own y axis is the spin axis; forward rolling along +x has a positive spin about +y.
struct RimState {
  Vec3 position = Vec3::Zero();          // rim centre, m, W
  Quat orientation = Quat::Identity();   // R_WR
  Vec3 velocity = Vec3::Zero();          // of the rim centre, m/s, W
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, W
};

/// Force and moment about the rim centre, W.
struct Wrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 moment = Vec3::Zero();  // N m
};

/// Connectivity of a contact surface; triangles run counter-clockwise seen from outside the tire.
struct SurfaceMesh {
  int vertex_count = 0;
  std::vector<std::array<int, 3>> triangles;
};

/// Vertex positions (m) and velocities (m/s) of a contact surface at one instant, W; length = vertex_count.
struct SurfaceState {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
};

/// How a nodal force answers to the motion of its vertex, means over the interval in which it acted: over an interval in
/// which the vertex moves otherwise it would be about force − stiffness (x − position) − damping (v − velocity).
struct ContactTangent {
  Mat3 stiffness = Mat3::Zero();  // −∂f/∂x, N/m, W, symmetric, not negative
  Mat3 damping = Mat3::Zero();    // −∂f/∂v, N s/m, likewise
  Vec3 position = Vec3::Zero();   // of the vertex as the terrain moved it, m
  Vec3 velocity = Vec3::Zero();   // m/s
};

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

/// Mass properties of the tire as a rigid body, centre of mass at the rim centre.
struct MassProperties {
  double mass = 0.0;            // kg
  Mat3 inertia = Mat3::Zero();  // about the rim centre, rim axes, kg m²
};

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

}  // namespace furrow
