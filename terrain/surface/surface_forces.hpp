// Distributes contact forces on a surface to its vertices, and sums them over one communication interval.
//
// A force f at p = Σ w_a x_a of a triangle acts on its vertices as w_a f. Then Σ w_a f = f and Σ x_a × w_a f = p × f:
// force and moment are transferred exactly in the configuration in which f was evaluated. A couple acts on the patch of
// its triangle (surface_patches.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"
#include "terrain/surface/surface_collider.hpp"
#include "terrain/surface/surface_patches.hpp"

namespace furrow::terrain {

/// How one contact's force on the surface responds to the motion of the surface at its point:
///   df = −[k_n n nᵀ + k_t (I − n nᵀ)] dx − [c_n n nᵀ + c_t (I − n nᵀ)] dv.
struct SurfaceContactTangent {
  Vec3 normal = Vec3::Zero();   // n, unit, W
  double k_n = 0.0, k_t = 0.0;  // N/m
  double c_n = 0.0, c_t = 0.0;  // N s/m
  double k_r = 0.0, c_r = 0.0;  // of the couple: dM = −(k_r dθ + c_r dω) across n, N m, N m s

  Mat3 stiffness() const { return k_t * Mat3::Identity() + (k_n - k_t) * normal * normal.transpose(); }
  Mat3 damping() const { return c_t * Mat3::Identity() + (c_n - c_t) * normal * normal.transpose(); }
};

/// One contact's force on the surface (the tire) by the terrain; total force = normal + tangential.
struct SurfaceContactForce {
  int triangle = -1;
  std::array<double, 3> weight{};  // of the hit
  Vec3 point = Vec3::Zero();       // of the hit, m, W
  Vec3 normal = Vec3::Zero();      // N, W
  Vec3 tangential = Vec3::Zero();  // N, W
  SurfaceContactTangent tangent;   // read only where tangents are wanted
  PatchCouple couple;              // W, in addition to the force at the point
  bool slides = false;             // its friction is at the limit
};

struct SurfaceNow {
  std::span<const std::array<int, 3>> triangles;
  std::span<const Vec3> position;  // m
  std::span<const Vec3> velocity;  // m/s
};

class NodalForceSum {
 public:
  /// @param tangents whether to sum the vertices' tangents as well. Each contact's tangent is distributed by the
  /// weights of its point, so the sum is exact for a motion that the three vertices share.
  /// @param patches on which couples act; without patches there must be no couples
  explicit NodalForceSum(int vertex_count, bool tangents = false, SurfacePatches patches = {});

  const SurfacePatches& patches() const { return patches_; }
  void set_patches(SurfacePatches patches) { patches_ = std::move(patches); }

  /// Adds the forces of one substep of length dt. It is serial, in the order given. The caller keeps that order fixed
  /// (for example by grain), so that the bits do not depend on threads. Touches only vertices of touched triangles.
  /// @param advance time that the substep advances, s: the weight of tangents in their means; forces act for dt instead
  /// @pre dt > 0, advance > 0; the surface has a position and a velocity for each vertex
  void add_substep(std::span<const SurfaceContactForce> contacts, const SurfaceNow& surface, double dt, double advance);
  void add_substep(std::span<const SurfaceContactForce> contacts, const SurfaceNow& surface, double dt) {
    add_substep(contacts, surface, dt, dt);
  }
  void add_substep(std::span<const SurfaceContactForce> contacts, const SurfaceCollider& surface, double dt,
                   double advance) {
    add_substep(contacts, {surface.mesh().triangles, surface.positions(), surface.velocities()}, dt, advance);
  }
  void add_substep(std::span<const SurfaceContactForce> contacts, const SurfaceCollider& surface, double dt) {
    add_substep(contacts, surface, dt, dt);
  }

  /// Interval means: impulses divided by `duration`; clears the sums for the next interval. @pre duration > 0
  void finish(double duration, NodalForces& forces, ContactSums& sums);

  /// Impulse given to the surface since the last finish(), N s.
  Vec3 impulse() const;

 private:
  void add_tangents(std::span<const SurfaceContactForce> contacts, const SurfaceNow& surface, double dt);
  void finish_tangents(double duration, NodalForces& forces);

  SurfacePatches patches_;
  std::vector<Vec3> impulse_;  // per vertex, N s
  std::vector<std::uint8_t> touched_;
  std::vector<int> touched_list_;    // in order of first touch
  std::vector<Vec3> substep_force_;  // per vertex, this substep, N
  std::vector<std::uint8_t> substep_touched_;
  std::vector<int> substep_list_;
  ContactSums sums_;                     // impulses (N s, N m s) until finish()
  std::vector<ContactTangent> tangent_;  // per vertex, times time; empty: not wanted
};

}  // namespace furrow::terrain
