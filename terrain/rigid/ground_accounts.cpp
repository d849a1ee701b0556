#include "terrain/rigid/ground_accounts.hpp"

#include "protocol/core/assert.hpp"

namespace furrow::terrain {

void add_normal_loss(const GroundLaw& law, const GroundPoint& at, double force, double velocity, double dt,
                     GroundLosses& losses) {
  FURROW_ASSERT(force >= 0.0 && dt > 0.0, force, dt);
  losses.normal_damping -= (force - law.stiffness * at.depth * at.area) * velocity * dt;
}

void add_shear_losses(const GroundLaw& law, const GroundShear& before, const GroundShear& begin, const GroundShear& end,
                      const Vec3& force, const Vec3& velocity, double dt, GroundLosses& losses) {
  FURROW_ASSERT(dt > 0.0, dt);
  losses.opening += before.energy(law) - begin.energy(law);
  if (force.isZero(0.0)) {  // nothing bears: the layer is let go
    losses.opening += begin.energy(law) - end.energy(law);
    return;
  }
  const Vec3 flat(velocity.x(), velocity.y(), 0.0);
  const Vec3 rate = (end.shear - begin.shear) / dt;  // ξ̇ = v − s
  losses.sliding -= force.dot(flat - rate) * dt;
  // Backward Euler: the force is that of the shear at the substep's end, so ½ κ_t A |ξ' −
  // ξ|² of its work is not stored.
  const double damping = law.damping + 0.5 * law.shear_stiffness * dt;
  losses.tangential_damping += damping * begin.area * rate.squaredNorm() * dt;
}

}  // namespace furrow::terrain
