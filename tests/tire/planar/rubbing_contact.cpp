#include "tests/tire/planar/rubbing_contact.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::tire {

double planar_normal_force(double stiffness, double depth, double separation, double mass, double step) {
  FURROW_ASSERT(depth >= 0.0 && mass > 0.0 && step > 0.0, depth, mass, step);
  const double force = stiffness * depth, travel = 0.5 * force / mass * step * step + separation * step;
  return travel > depth ? force * depth / travel : force;
}

double planar_friction_force(double friction, double normal, double sliding, double mass, double step) {
  return std::min(friction * normal, std::abs(sliding) * mass / step);
}

void RubbingContact::load(const PlanarState& state, const std::vector<double>& mass, double step, PlanarField& force) {
  find(state.x);
  const PlanarField& v = state.v;
  for (PlanarTouch& t : touches_) {
    const int b = t.b < 0 ? t.a : t.b;
    const double of_a = 1.0 - t.share, of_b = t.share;
    const double m = 1.0 / (of_a * of_a / mass[t.a] + of_b * of_b / mass[b]);
    const double vx = of_a * v.x[t.a] + of_b * v.x[b], vz = of_a * v.z[t.a] + of_b * v.z[b];
    const double sliding = vx * t.push_z - vz * t.push_x;
    t.force = planar_normal_force(law().stiffness, t.depth, vx * t.push_x + vz * t.push_z, m, step);
    t.friction = std::copysign(planar_friction_force(law().friction, t.force, sliding, m, step), -sliding);
    const double fx = t.force * t.push_x + t.friction * t.push_z, fz = t.force * t.push_z - t.friction * t.push_x;
    force.x[t.a] += of_a * fx, force.z[t.a] += of_a * fz;
    force.x[b] += of_b * fx, force.z[b] += of_b * fz;
  }
}

double RubbingContact::force_x() const {
  double sum = 0.0;
  for (const PlanarTouch& t : touches_) sum += t.force * t.push_x + t.friction * t.push_z;
  return sum;
}

}  // namespace furrow::tire
