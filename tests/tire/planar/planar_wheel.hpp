// A planar wheel in motion: disc and tire of triangles on rigid ground. Its centre node is linked to a vehicle; couples
// on the disc's rim drive and brake it.
//
// The couple M about +y (forward rolling turns that way) acts as forces M (z, −x)/Σr² on the rim's nodes, x and z from
// their middle: a pure couple in every shape.
#pragma once

#include "protocol/core/outcome.hpp"
#include "tests/tire/planar/planar_motion.hpp"
#include "tire/planar/planar_params.hpp"
#include "tire/planar/rubbing_contact.hpp"

namespace furrow::tire {

/// The vehicle's action on the wheel's centre. A held direction moves with the velocity, the other directions by the
/// force.
struct PlanarLink {
  bool hold_x = false, hold_z = false;
  double velocity_x = 0.0, velocity_z = 0.0;  // of held directions, m/s
  double force_x = 0.0, force_z = 0.0;        // N
};

class PlanarWheel {
 public:
  /// Undeformed with its centre at (x, z), moving with the velocity (m/s) and the spin (about +y, rad/s) given.
  /// @param axle_mass of the parts that move with the centre, kg
  PlanarWheel(const PlanarParams& params, PlanarGround ground, PlanarPoint centre, PlanarPoint velocity, double spin,
              double axle_mass, double gravity);
  PlanarWheel(const PlanarWheel&) = delete;
  PlanarWheel& operator=(const PlanarWheel&) = delete;

  double step() const { return step_; }  // s
  /// @pre the same directions are held as in the first call
  void link(const PlanarLink& link);
  void set_couple(double couple) { couple_ = couple; }  // about +y, N m

  /// Makes one step. @returns failure when a triangle is turned inside out, or so thin that the step is too large
  Outcome advance();

  const PlanarMesh& mesh() const { return mesh_; }
  const PlanarMotion& motion() const { return motion_; }
  const RubbingContact& contact() const { return contact_; }
  PlanarPoint centre() const { return {motion_.state().x.x[mesh_.centre], motion_.state().x.z[mesh_.centre]}; }
  PlanarPoint centre_velocity() const;
  double spin() const;  // of the rim, about +y, rad/s
  double mass() const;  // with the axle, kg

 private:
  void load(const PlanarState& state, double step, PlanarField& force);

  PlanarMesh mesh_;
  PlanarMotion motion_;
  RubbingContact contact_;
  PlanarLink link_;
  double couple_ = 0.0, gravity_ = 0.0, step_ = 0.0;
  bool linked_ = false;
  long steps_ = 0;
};

}  // namespace furrow::tire
