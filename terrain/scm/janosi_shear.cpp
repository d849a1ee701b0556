#include "terrain/scm/janosi_shear.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain::scm {

double ShearLaw::limit(double pressure) const {
  FURROW_ASSERT(pressure >= 0.0, pressure);
  return std::min(cohesion + pressure * tan_phi, friction * pressure);
}

double ShearLaw::stored(double limit, const Vec3& mobilized) const { return 0.5 * K * limit * mobilized.squaredNorm(); }

ShearStep shear(const ShearLaw& law, const Vec3& velocity, double dt, Vec3& mobilized) {
  FURROW_ASSERT(dt > 0.0 && law.K > 0.0, dt, law.K);
  ShearStep step;
  const double speed = velocity.norm(), a = speed * dt / law.K;
  step.mean = mobilized;
  if (!(a > 0.0)) return step;
  // With s = |v| t/K from 0 to a:  m = v̂ + d exp(−s),  d = m_0 − v̂.
  const Vec3 direction = velocity / speed, d = mobilized - direction;
  const double gone = -std::expm1(-a), gone_twice = -std::expm1(-2.0 * a);
  step.mean = direction + gone / a * d;
  step.sliding = law.K * (a + 2.0 * d.dot(direction) * gone + 0.5 * d.squaredNorm() * gone_twice);
  mobilized = direction + std::exp(-a) * d;
  return step;
}

}  // namespace furrow::terrain::scm
