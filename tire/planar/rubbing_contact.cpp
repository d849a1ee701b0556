#include "tire/planar/rubbing_contact.hpp"

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

void RubbingContact::rub(const PlanarState& state, const std::vector<double>& mass, double step,
                         const std::vector<double>& across) {
  find(state.x);
  const PlanarField& v = state.v;
  for (PlanarTouch& t : touches_) {
    const int b = t.other();
    const double of_a = 1.0 - t.share, of_b = t.share;
    const double m = 1.0 / (of_a * of_a / mass[t.a] + of_b * of_b / mass[b]);
    const double vx = of_a * v.x[t.a] + of_b * v.x[b], vz = of_a * v.z[t.a] + of_b * v.z[b];
    const double sliding = vx * t.push_z - vz * t.push_x;
    const double aside = across.empty() ? 0.0 : of_a * across[t.a] + of_b * across[b];
    const double speed = std::hypot(sliding, aside);
    t.force = planar_normal_force(law().stiffness, t.depth, vx * t.push_x + vz * t.push_z, m, step);
    if (!(speed > 0.0)) continue;
    const double friction = planar_friction_force(law().friction, t.force, speed, m, step);
    t.friction = -friction * (sliding / speed);
    t.across = -friction * (aside / speed);
  }
}

void RubbingContact::load(const PlanarState& state, const std::vector<double>& mass, double step, PlanarField& force) {
  rub(state, mass, step);
  for (const PlanarTouch& t : touches_) {
    const double fx = t.force_x(), fz = t.force_z();
    force.x[t.a] += (1.0 - t.share) * fx, force.z[t.a] += (1.0 - t.share) * fz;
    force.x[t.other()] += t.share * fx, force.z[t.other()] += t.share * fz;
  }
}

double RubbingContact::force_x() const {
  double sum = 0.0;
  for (const PlanarTouch& t : touches_) sum += t.force_x();
  return sum;
}

}  // namespace furrow::tire
