// What leaves the elastic layer of the rigid ground, by mechanism, in every substep.
//
//   normal damping      −(p − κ g) A ż dt, whether the pressure p is cut at 0 or not
//   sliding             −F·s dt
//   tangential damping  (d + ½ κ_t dt) A |v − s|² dt: a backward Euler step of the shear damps it by ½ κ_t dt beside d
//   opening             what the shear ½ κ_t A ξ² of a vertex gives up as its area changes and where its load ends
#pragma once

#include "protocol/core/fields.hpp"
#include "protocol/core/vec.hpp"
#include "terrain/rigid/ground_pressure.hpp"

namespace furrow::terrain {

/// Since the run began, J.
struct GroundLosses {
  double sliding = 0.0;
  double normal_damping = 0.0;
  double tangential_damping = 0.0;
  double opening = 0.0;
};
void visit_fields(FieldsOf<GroundLosses> auto& s, auto&& visit) {
  visit(s.sliding, Field{"sliding", "J"});
  visit(s.normal_damping, Field{"normal_damping", "J"});
  visit(s.tangential_damping, Field{"tangential_damping", "J"});
  visit(s.opening, Field{"opening", "J"});
}

/// The shear of the layer under one vertex, and the area that bears it.
struct GroundShear {
  Vec3 shear = Vec3::Zero();  // ξ, m
  double area = 0.0;          // m²

  /// J
  double energy(const GroundLaw& law) const { return 0.5 * law.shear_stiffness * area * shear.squaredNorm(); }
};

/// One integration point that bears `force` while it rises with `velocity`, for dt.
void add_normal_loss(const GroundLaw& law, const GroundPoint& at, double force, double velocity, double dt,
                     GroundLosses& losses);

/// One vertex on which `force` acts for dt while it moves with `velocity`. @param before as the substep before left it
/// @param begin with the area of this substep @param end after it
void add_shear_losses(const GroundLaw& law, const GroundShear& before, const GroundShear& begin, const GroundShear& end,
                      const Vec3& force, const Vec3& velocity, double dt, GroundLosses& losses);

}  // namespace furrow::terrain
